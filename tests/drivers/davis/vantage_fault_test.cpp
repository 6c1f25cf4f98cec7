// What a Davis console and its line can do wrong, and what the driver makes of it: with a simulated console at the
// other end of a real pseudo terminal or TCP connection.
#include <memory>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/davis/vantage_sensor.hpp"
#include "simulators/davis/vantage_console.hpp"
#include "tests/drivers/davis/davis_fault.hpp"
#include "tests/support/driver_named.hpp"
#include "tests/support/free_port.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::drivers::davis {
namespace {

using simulators::core::FaultKind;
using simulators::davis::VantageConsole;
using simulators::davis::VantageConsoleOptions;
using testing::HasSubstr;

class VantageFault : public DavisFault {
 protected:
  enum class Wire { kPty, kTcp };

  void connect(Wire wire, const VantageConsoleOptions& options = {}) {
    bench_.put(nullptr, nullptr);  // the name of the port is free again
    const std::string link = (folder_ / "console").string();
    auto carried = wire == Wire::kPty ? simulators::text::make_pty_wire(link)
                                      : simulators::text::make_tcp_wire("127.0.0.1", free_port(SOCK_STREAM));
    const std::string place = carried->place();
    ParameterValues::Map given = {{"device", link}};
    if (wire == Wire::kTcp) {
      given = {{"transport", std::string("tcp")},
               {"host", std::string("127.0.0.1")},
               {"port", std::int64_t{std::stoi(place.substr(place.rfind(':') + 1))}}};
    }
    auto console = std::make_unique<VantageConsole>(bench_.observed(std::move(carried)), options, still_wind());
    console_ = console.get();
    const VantageSettings settings = vantage_settings_of(values_for("davis", given));
    bench_.put(std::move(console), std::make_unique<VantageSensor>(settings, bench_.port(settings.address)));
  }

  VantageConsole* console_ = nullptr;

 private:
  test::TemporaryFolder folder_;
};

/// Through the end of the first packets that it was asked for, and of the second.
TEST_F(VantageFault, WithoutAnyNothingIsLost) {
  for (const Wire wire : {Wire::kPty, Wire::kTcp}) {
    const bool knows_lps = wire == Wire::kPty;
    connect(wire, {.interval_s = 0.25, .knows_lps = knows_lps});
    ASSERT_TRUE(is_live()) << bench_.sink.last_detail();
    bench_.run(110.0);
    EXPECT_GE(bench_.sink.readings.size(), 430U) << "a packet every 0.25 s, but while it is asked again";
    EXPECT_TRUE(bench_.sink.refusals.empty());
    expect_only_the_wind();
    EXPECT_EQ(bench_.sink.readings.back().gust_m_s.has_value(), knows_lps);
    expect_weather();
  }
}

TEST_F(VantageFault, WithoutAnyTheConsoleIsLeftAsleep) {
  connect(Wire::kTcp);  // a pseudo terminal loses what has not been read when it is closed
  ASSERT_TRUE(is_live());
  EXPECT_GT(console_->packets_left(), 0);
  bench_.close_sensor();
  EXPECT_EQ(console_->packets_left(), 0) << "it was told to end";
}

TEST_F(VantageFault, Silence) {
  for (const Wire wire : {Wire::kPty, Wire::kTcp}) {
    connect(wire);
    ASSERT_TRUE(is_live()) << bench_.sink.last_detail();
    bench_.run(1.0);
    expect_no_wind(FaultKind::kSilence, 6.0, "was asked for packets, but sends none: check its power");
    bench_.run(10.0, FaultKind::kSilence);
    EXPECT_GE(bench_.sink.count(decode::Refusal::kTimeout), 3);
    EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("does not wake up"));
    expect_return();
  }
}

TEST_F(VantageFault, Freeze) {
  connect(Wire::kPty);
  expect_freeze_is_published();
}

TEST_F(VantageFault, Spike) {
  connect(Wire::kPty);
  expect_spike_is_not_believed();
}

TEST_F(VantageFault, Garbage) {
  for (const Wire wire : {Wire::kPty, Wire::kTcp}) {
    connect(wire);
    ASSERT_TRUE(is_live());
    expect_no_wind(FaultKind::kGarbage, 25.0, "packets arrive damaged");
    EXPECT_GE(bench_.sink.count(decode::Refusal::kMalformed), 5);
    expect_return();
  }
}

TEST_F(VantageFault, Split) {
  for (const Wire wire : {Wire::kPty, Wire::kTcp}) {
    connect(wire);
    ASSERT_TRUE(is_live());
    bench_.run(20.0, FaultKind::kSplit);
    EXPECT_GE(bench_.sink.readings.size(), 7U);
    EXPECT_TRUE(bench_.sink.refusals.empty());
    expect_only_the_wind();
    expect_return();
  }
}

TEST_F(VantageFault, Partial) {
  for (const Wire wire : {Wire::kPty, Wire::kTcp}) {
    connect(wire);
    ASSERT_TRUE(is_live());
    expect_no_wind(FaultKind::kPartial, 30.0, "packets arrive damaged");
    EXPECT_GE(bench_.sink.count(decode::Refusal::kTooShort), 4);
    ASSERT_TRUE(is_live());
    expect_return();
  }
}

TEST_F(VantageFault, BadChecksum) {
  for (const Wire wire : {Wire::kPty, Wire::kTcp}) {
    connect(wire);
    ASSERT_TRUE(is_live());
    expect_no_wind(FaultKind::kBadChecksum, 30.0, "packets arrive damaged");
    EXPECT_GE(bench_.sink.count(decode::Refusal::kBadChecksum), 6);
    expect_return();
  }
}

TEST_F(VantageFault, Late) {
  connect(Wire::kPty);
  bench_.run(60.0, FaultKind::kLate);
  EXPECT_GE(bench_.sink.count(decode::Refusal::kTimeout), 2);
  expect_only_the_wind();  // a packet is no answer to one question alone: late, it is still the wind
  ASSERT_TRUE(is_live()) << bench_.sink.last_detail();
  bench_.run(5.0);
  expect_return();
}

TEST_F(VantageFault, Exception) {
  connect(Wire::kPty);
  bench_.run(10.0, FaultKind::kException);
  EXPECT_TRUE(bench_.sink.readings.empty());
  EXPECT_GE(bench_.sink.count(decode::Refusal::kException), 4);
  EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("check that it is a Davis console"));
  expect_return();
}

TEST_F(VantageFault, Disconnect) {
  connect(Wire::kTcp);
  ASSERT_TRUE(is_live());
  expect_no_wind(FaultKind::kDisconnect, 5.0, "cannot connect to 127.0.0.1:");
  expect_return();
}

TEST_F(VantageFault, Unplug) {
  for (const Wire wire : {Wire::kPty, Wire::kTcp}) {
    connect(wire);
    ASSERT_TRUE(is_live());
    bench_.run(6.0, FaultKind::kUnplug);
    EXPECT_TRUE(bench_.sink.readings.empty());
    EXPECT_EQ(bench_.sink.last_state(), wind::LinkState::kConnecting);
    expect_return();
  }
}

}  // namespace
}  // namespace yuragi::drivers::davis
