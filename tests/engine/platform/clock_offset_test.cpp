#include "engine/platform/clock_offset.hpp"

#include <chrono>
#include <string>

#include <gtest/gtest.h>

#include "engine/platform/clock_watch.hpp"

namespace yuragi::platform {
namespace {

using namespace std::chrono_literals;

UtcTime now() {
  return std::chrono::system_clock::now();
}

// As chronyc 4.3 printed it of a server whose clock was 20 ms ahead.
const UtcTime kTracked{std::chrono::milliseconds(1795972659700)};
const std::string kTracking =
    "7F000001,127.0.0.1,2,1795972659.711421277,0.019997565,0.000000096,0.000000200,0.121,0.007,0.315,0.000007142,"
    "0.000001236,0.3,Normal\n";

TEST(ChronyOffset, IsThatOfItsTracking) {
  const auto offset_s = chrony_offset_s(kTracking, kTracked);
  ASSERT_TRUE(offset_s);
  EXPECT_NEAR(*offset_s, -0.019997565, 1e-12);
  EXPECT_TRUE(chrony_offset_s(kTracking, kTracked + 7000s));
}

TEST(ChronyOffset, IsUnknownInAnythingElse) {
  EXPECT_FALSE(chrony_offset_s(kTracking, kTracked + 7300s)) << "too old";
  std::string unsynchronised = kTracking;
  unsynchronised.replace(unsynchronised.find("Normal"), 6, "Not synchronised");
  EXPECT_FALSE(chrony_offset_s(unsynchronised, kTracked));
  for (const char* offset : {"nan", "inf", "1e10", "", "0.01 s", "0x1"}) {
    std::string text = kTracking;
    text.replace(text.find("0.019997565"), 11, offset);
    EXPECT_FALSE(chrony_offset_s(text, kTracked)) << offset;
  }
  for (std::size_t length = 0; length + 1 < kTracking.size(); ++length)
    EXPECT_FALSE(chrony_offset_s(kTracking.substr(0, length), kTracked)) << length;
}

// Of the property's type (uuuuittayttttbtt): leap, version, mode, stratum, precision, root delay and dispersion, the 4
// bytes of the reference, the four times, whether it was ignored, the number of packets, jitter.
const UtcTime kAnswered{std::chrono::milliseconds(1795972659030)};
const std::string kMessage =
    "(uuuuittayttttbtt) 0 4 4 2 -25 15000 400 4 10 0 0 1 1795972659000000 1795972659023000 1795972659023100 "
    "1795972659030000 false 12 345\n";

TEST(TimesyncdOffset, IsThatOfItsLastMessage) {
  const auto offset_s = timesyncd_offset_s(kMessage, kAnswered);
  ASSERT_TRUE(offset_s);
  EXPECT_NEAR(*offset_s, -0.00805, 1e-6);  // the server's clock was ahead by ((23 - 0) + (23.1 - 30)) / 2 ms
}

TEST(TimesyncdOffset, IsUnknownInAnythingElse) {
  EXPECT_FALSE(timesyncd_offset_s(kMessage, kAnswered + 7300s)) << "too old";
  EXPECT_FALSE(timesyncd_offset_s("(uuuuittayttttbtt) 0 0 0 0 0 0 0 0 0 0 0 0 false 0 0", kAnswered));
  std::string unsynchronised = kMessage;
  unsynchronised.replace(unsynchronised.find(" 0 4 4"), 2, " 3");
  EXPECT_FALSE(timesyncd_offset_s(unsynchronised, kAnswered));
  for (const char* bytes : {"5", "3", "17", "-4", "18446744073709551615"}) {
    std::string text = kMessage;
    text.replace(text.find(" 4 10") + 1, 1, bytes);
    EXPECT_FALSE(timesyncd_offset_s(text, kAnswered)) << bytes;
  }
  for (std::size_t length = 0; length + 4 < kMessage.size(); ++length)
    EXPECT_FALSE(timesyncd_offset_s(kMessage.substr(0, length), kAnswered)) << length;
}

TEST(ClockOffset, IsAskedOfOneProgramAfterTheOther) {
  const std::string shown = "printf '%s' '7F000001,127.0.0.1,2,'$(date +%s).5',-0.25,0,0,0,0,0,0,0,0.3,Normal'";
  const ClockPrograms chrony{.chrony = {"/bin/sh", "-c", shown}, .timesyncd = {"/nowhere/busctl"}};
  EXPECT_EQ(read_clock_offset(now(), chrony), (ClockOffset{.offset_s = 0.25, .source = "chrony"}));
  EXPECT_TRUE(read_clock_offset(now(), chrony).is_large());

  const std::string message =
      "t=$(date +%s)000000; echo \"(uuuuittayttttbtt) 0 4 4 2 -25 0 0 0 $t $t $t $t false 1 1\"";
  const ClockPrograms timesyncd{.chrony = {"/bin/false"}, .timesyncd = {"/bin/sh", "-c", message}};
  EXPECT_EQ(read_clock_offset(now(), timesyncd).offset_s, 0.0);

  const ClockPrograms none{.chrony = {"/nowhere/chronyc"}, .timesyncd = {"/bin/sh", "-c", "yes"}};
  EXPECT_FALSE(read_clock_offset(now(), none).source.empty()) << "whatever the kernel of this machine reports";
}

TEST(ClockOffset, OfAProgramThatHangsIsNotWaitedForAtTheEnd) {
  // The destructor would wait for ever.
  const ClockWatch watch(now, {.chrony = {"/bin/sh", "-c", "exec sleep 1000"}, .timesyncd = {"/nowhere/busctl"}});
  EXPECT_FALSE(watch.latest().offset_s);
}

TEST(ClockOffset, HasWords) {
  EXPECT_EQ(text_of({.offset_s = 0.0003, .source = "chrony"}), "clock 0.30 ms ahead of UTC (chrony)");
  EXPECT_EQ(text_of({.offset_s = -2.0, .source = "chrony"}), "clock 2000 ms behind UTC (chrony)");
  EXPECT_EQ(text_of({.offset_s = std::nullopt, .source = "no time service replies"}),
            "clock's offset unknown (no time service replies)");
}

}  // namespace
}  // namespace yuragi::platform
