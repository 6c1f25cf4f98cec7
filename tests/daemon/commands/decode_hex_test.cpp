// `yuragi decode --hex`: stations, counters and Modbus, one unit a line.
#include <algorithm>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/tools/decode/hex_text.hpp"
#include "tests/daemon/commands/decode_run.hpp"
#include "tests/support/places.hpp"

namespace yuragi::daemon::commands {
namespace {

using Arguments = std::vector<std::string>;
using nlohmann::json;
using ::testing::HasSubstr;

TEST_F(DecodeCommand, TakesHexadecimalDigitsAsPeopleWriteThem) {
  for (const char* line : {"01 cd ff 71 01 39 39 71 03 ff",
                           "01cdff7101393971"
                           "03ff",
                           "01:CD:FF:71:01:39:39:71:03:FF", "0x01,0xcd,0xff,0x71,0x01,0x39,0x39,0x71,0x03,0xff",
                           "  01-cd-ff-71-01-39-39-71-03-ff\t\r"}) {
    EXPECT_TRUE(is_value(one(std::string("# R1\n\n") + line + "\n", {"acurite", "--hex"})["speed_m_s"], 2.8072))
        << line;
  }
  for (const char* line : {"01 c", "0 1", "hello", "01 0x", "01_02"}) {
    const auto done = run(std::string(line) + "\n", {"acurite", "--hex", "--refused"});
    ASSERT_EQ(done.objects.size(), 1U) << line;
    EXPECT_EQ(done.objects[0]["detail"], "not hexadecimal digits, two per byte") << line;
    EXPECT_EQ(done.objects[0]["input"], line);
  }
}

TEST_F(DecodeCommand, TakesTextInHexadecimalDigitsToo) {
  // "$WIMWV,214.8,R,10.0,N,A*1D" and a line end
  json reading =
      one("24 57 49 4d 57 56 2c 32 31 34 2e 38 2c 52 2c 31 30 2e 30 2c 4e 2c 41 2a 31 44 0d 0a\n", {"nmea", "--hex"});
  EXPECT_TRUE(is_value(reading["direction_deg"], 214.8));
}

TEST_F(DecodeCommand, MakesOneStreamOfTheBytesOfAWmr100) {
  const auto done = run("ff ff 00 48 0a\n0c 16 e0 02\n00 20 76 01 ff ff\n", {"wmr100", "--hex"});
  ASSERT_EQ(done.objects.size(), 1U) << done.error;
  EXPECT_TRUE(is_value(done.objects[0]["speed_m_s"], 4.6));
  EXPECT_TRUE(done.objects[0]["gust_m_s"].is_null()) << "2.2 m/s, below the average";
}

TEST_F(DecodeCommand, ReadsEachKindOfStationByItsFormat) {
  // A block of 34 bytes at 0x020001: 5a, data, gust 12.3 and speed 8.7 mph, from west, and the exclusive or of all.
  std::vector<std::uint8_t> te923(34, 0x11);
  te923[0] = 0x5A;
  const std::vector<std::uint8_t> wind = {0x23, 0x01, 0x87, 0x00, 0x0C};
  std::ranges::copy(wind, te923.begin() + 26);
  te923[33] = 0;
  for (std::size_t i = 0; i < 33; ++i) te923[33] ^= te923[i];
  json block = one(tools::decode::to_hex(te923) + "\n", {"te923", "--hex"});
  EXPECT_TRUE(is_value(block["speed_m_s"], 8.7 * 0.44704, 1e-9));
  EXPECT_TRUE(is_value(block["gust_m_s"], 12.3 * 0.44704, 1e-9));
  EXPECT_TRUE(is_value(block["direction_deg"], 270.0));

  // Packet d4 of 54 bytes: gust 3.4 m/s, average 2.9 m/s from 13 degrees; the sum of all before at the end.
  std::vector<std::uint8_t> wmr300(54, 0);
  const std::vector<std::uint8_t> head = {0xD4, 0x36, 14, 5, 9, 18, 20, 1, 0, 34, 0, 168, 0, 29, 0, 13};
  std::ranges::copy(head, wmr300.begin());
  unsigned sum = 0;
  for (const std::uint8_t byte : wmr300) sum += byte;
  wmr300[52] = static_cast<std::uint8_t>(sum >> 8U);
  wmr300[53] = static_cast<std::uint8_t>(sum & 0xFFU);
  json packet = one(tools::decode::to_hex(wmr300) + "\n", {"wmr300", "--hex"});
  EXPECT_TRUE(is_value(packet["speed_m_s"], 2.9, 1e-9));
  EXPECT_TRUE(is_value(packet["gust_m_s"], 3.4, 1e-9));
  EXPECT_TRUE(is_value(packet["direction_deg"], 13.0));

  json record = one("05 2d c8 00 3a 78 00 a4 27 2f 48 00 06 00 00 00\n", {"fineoffset", "--hex"});
  EXPECT_TRUE(is_value(record["speed_m_s"], 4.7, 1e-9));
  EXPECT_TRUE(is_value(record["direction_deg"], 135.0));

  // A packet LOOP2, of PyVantagePro's tests.
  json loop2 = one(
      "4C4F4FEC01FF7F95745D033A860305FF3B012300180007003B01FF7FFF7F4A00FF3CFF65005A0066000000FF78000000FFFF00000000000"
      "0BF000000020000C9FF0E720E72BE74FF07060C0E0D090C39160202FF7FFF7FFF7FFF7FFF7FFF7F0A0DCBFD\n",
      {"davis", "--hex"});
  EXPECT_TRUE(is_value(loop2["speed_m_s"], 2.2352, 1e-9));
  EXPECT_TRUE(is_value(loop2["gust_m_s"], 3.12928, 1e-9));
  EXPECT_TRUE(is_value(loop2["direction_deg"], 315.0));

  // 4.5 m/s and its gust, from 123.5 degrees; and a temperature alone, of the V200A's manual.
  json umb =
      one("01 10 01 F0 01 80 1F 02 2F 10 00 03 08 00 90 01 16 00 00 90 40 08 00 F4 01 16 00 00 F7 42 08 00 B8 01 16 00 "
          "00 E0 "
          "40 03 9E E1 04\n",
          {"umb-binary", "--hex"});
  EXPECT_TRUE(is_value(umb["speed_m_s"], 4.5));
  EXPECT_TRUE(is_value(umb["gust_m_s"], 7.0));
  EXPECT_TRUE(is_value(umb["direction_deg"], 123.5));
  const auto temperature =
      run("01 10 01 F0 01 80 0A 02 23 10 00 64 00 16 00 00 B4 41 03 1F 94 04\n", {"umb-binary", "--hex"});
  EXPECT_TRUE(temperature.objects.empty());

  // Counter 1234 and half of 2.44 V, with the sums of the U3's frames.
  json labjack = one("ff f8 05 00 00 02 00 00 00 b0 7a d2 04 00 00 00\n", {"labjack", "--hex"});
  EXPECT_EQ(labjack["count"], 1234);
  EXPECT_TRUE(is_value(labjack["volts"], 1.16934, 1e-4));
}

TEST_F(DecodeCommand, PutsReportsTogetherAsTheyComeOverUsb) {
  const auto wmr100 =
      run("20 00 08 01 00 00 00 00 | 04 ff ff 00 48 00 00 00\n07 0a 0c 16 e0 02 00 20\n02 76 01 11 22 33 44 55\n",
          {"wmr100", "--hex", "--reports"});
  ASSERT_EQ(wmr100.objects.size(), 1U) << wmr100.error;
  EXPECT_EQ(wmr100.objects[0]["speed_m_s"], 4.6);
  EXPECT_EQ(run("04 ff ff\n", {"wmr100", "--hex", "--reports", "--refused"}).objects.at(0)["refused"], "too short");

  // A block of 34 bytes, seven a report; its header, data, wind, and check byte.
  std::vector<std::uint8_t> block(34, 0x11);
  block[0] = 0x5A;
  const std::vector<std::uint8_t> wind = {0x23, 0x01, 0x87, 0x00, 0x0C};
  std::ranges::copy(wind, block.begin() + 26);
  block[33] = 0;
  for (std::size_t i = 0; i < 33; ++i) block[33] ^= block[i];
  std::string lines = "05 af 01 00 02 ac 00 00 | ";
  for (std::size_t at = 0; at < block.size(); at += 7) {
    const std::size_t count = std::min<std::size_t>(7, block.size() - at);
    std::vector<std::uint8_t> report(8, 0xEE);
    report[0] = static_cast<std::uint8_t>(count);
    std::copy_n(block.begin() + static_cast<std::ptrdiff_t>(at), count, report.begin() + 1);
    lines += tools::decode::to_hex(report) + "\n";
  }
  const auto te923 = run(lines, {"te923", "--hex", "--reports", "--refused"});
  ASSERT_EQ(te923.objects.size(), 1U) << te923.text;
  EXPECT_TRUE(is_value(te923.objects[0].value("speed_m_s", json()), 8.7 * 0.44704, 1e-9));
  // The next request begins a new block, whatever became of the one before.
  const auto cut = run(lines.substr(0, lines.find('\n') + 1) + lines, {"te923", "--hex", "--reports", "--refused"});
  ASSERT_EQ(cut.objects.size(), 2U) << cut.text;
  EXPECT_EQ(cut.objects[0].value("refused", ""), "too short");
  EXPECT_TRUE(cut.objects[1].contains("speed_m_s"));
}

TEST_F(DecodeCommand, FindsTheCurrentRecordInReportsOfTheConsolesMemory) {
  const auto block = [](const char* request, const std::string& bytes) {
    std::string lines = std::string(request) + " | ";
    for (std::size_t at = 0; at < 4; ++at) lines += bytes.substr(at * 24, 23) + "\n";
    return lines;
  };
  // The current record is the second of the block at 0x0120. A record of 16 bytes: 4.7 m/s from 135 degrees.
  const std::string fixed =
      "55 aa ff ff ff ff ff ff ff ff ff ff ff ff ff ff 05 20 01 51 11 00 00 00 81 00 00 07 01 00 30 01";
  const std::string record = "05 2d c8 00 3a 78 00 a4 27 2f 48 00 06 00 00 00";
  const std::string other = "05 2d c8 00 3a 78 00 a4 27 0a 0a 00 00 00 00 00";
  const std::string input =
      block("a1 00 00 20 a1 00 00 20", fixed) + block("a1 01 20 20 a1 01 20 20", other + " " + record);
  const auto done = run(input, {"fineoffset", "--hex", "--reports", "--refused"});
  ASSERT_EQ(done.objects.size(), 1U) << done.text;
  EXPECT_TRUE(is_value(done.objects[0].value("speed_m_s", json()), 4.7, 1e-9));
  EXPECT_TRUE(is_value(done.objects[0].value("direction_deg", json()), 135.0));

  const auto lost = run(record.substr(0, 23) + "\n", {"fineoffset", "--hex", "--reports", "--refused"});
  ASSERT_EQ(lost.objects.size(), 1U);
  EXPECT_EQ(lost.objects[0]["refused"], "malformed") << "of which address?";
}

TEST_F(DecodeCommand, GivesCountsAndVoltsAndTheirMeaningWhereTheOptionsSayIt) {
  auto plain = run("d2 04 00 00\n00 0c\n", {"mcc1208", "--hex"});
  ASSERT_EQ(plain.objects.size(), 2U);
  EXPECT_EQ(plain.objects[0]["count"], 1234);
  EXPECT_TRUE(plain.objects[0]["speed_m_s"].is_null());
  EXPECT_FALSE(plain.objects[0].contains("volts"));
  EXPECT_TRUE(is_value(plain.objects[1]["volts"], 5.0, 1e-9));
  EXPECT_TRUE(plain.objects[1]["direction_deg"].is_null());

  // 20 pulses in 2 s, of 0.7 m each: 7 m/s. Half of a track of 356 degrees: 178.
  auto received = run("d2 04 00 00\ne6 04 00 00\n00 0c\n",
                      {"mcc1208", "--hex", "--slope", "0.7", "--interval", "2", "--vane-reference", "10"});
  ASSERT_EQ(received.objects.size(), 3U);
  EXPECT_TRUE(received.objects[0]["speed_m_s"].is_null()) << "one count is no speed";
  EXPECT_TRUE(is_value(received.objects[1]["speed_m_s"], 7.0, 1e-9));
  EXPECT_TRUE(is_value(received.objects[2]["direction_deg"], 178.0, 1e-9));
}

TEST_F(DecodeCommand, TakesACountersReplyForWhatWasAsked) {
  // Input 1 is calibrated (slope 1, intercept -10 steps); the same two bytes are no count.
  auto mcc =
      run("c0 30 08 01 00 00 08 00 | 00 00 80 3f 00 00 20 c1\n"
          "c0 10 01 00 01 00 02 00 | 0a 0c\n"
          "c0 20 00 00 00 00 04 00 | 0a 0c\n"
          "c0 20 00 00 00 00 04 00 | d2 04 00 00\n",
          {"mcc1208", "--hex", "--refused"});
  ASSERT_EQ(mcc.objects.size(), 3U) << mcc.text;
  EXPECT_TRUE(is_value(mcc.objects[0]["volts"], 5.0, 1e-9)) << mcc.objects[0];
  EXPECT_EQ(mcc.objects[1]["refused"], "too short");
  EXPECT_EQ(mcc.objects[2]["count"], 1234);

  // A U3 that was asked for the wiper, the voltage over the track, and Counter1: half of it, so half of the track.
  const std::vector<std::uint8_t> data = {0, 0, 9, 0x00, 0x40, 0x00, 0x80, 0xD2, 0x04, 0, 0, 0};
  unsigned sum = 0;
  for (const std::uint8_t byte : data) sum += byte;
  std::vector<std::uint8_t> reply = {
      0, 0xF8, 6, 0, static_cast<std::uint8_t>(sum & 0xFFU), static_cast<std::uint8_t>(sum >> 8U)};
  unsigned head = 0;
  for (const std::uint8_t byte : reply) head += byte;
  while (head > 0xFF) head = (head & 0xFFU) + (head >> 8U);
  reply[0] = static_cast<std::uint8_t>(head);
  reply.insert(reply.end(), data.begin(), data.end());
  const std::string command = "00 f8 05 00 00 00 09 01 00 1f 01 01 1f 37 00 00 | ";
  json labjack = one(command + tools::decode::to_hex(reply) + "\n", {"labjack", "--hex"});
  EXPECT_EQ(labjack["count"], 1234);
  EXPECT_TRUE(is_value(labjack["direction_deg"], 178.0, 0.01)) << labjack;
  EXPECT_EQ(run(tools::decode::to_hex(reply) + "\n", {"labjack", "--hex"}).objects.size(), 0U)
      << "what was asked cannot be guessed";
}

TEST_F(DecodeCommand, BeginsAnewAfterAReplyThatIsNoUse) {
  const Arguments arguments = {"mcc1208", "--hex", "--refused", "--slope", "0.7", "--interval", "2"};
  const auto done = run("d2 04 00 00\nd2 04 00\ne6 04 00 00\nfa 04 00 00\n", arguments);
  ASSERT_EQ(done.objects.size(), 4U) << done.text;
  EXPECT_EQ(done.objects[1]["refused"], "too short");
  EXPECT_TRUE(done.objects[2]["speed_m_s"].is_null()) << "how long ago the one before came is not known";
  EXPECT_TRUE(is_value(done.objects[3]["speed_m_s"], 7.0, 1e-9));

  const auto reset = run("d2 04 00 00\n00 00 00 00\n", arguments);
  ASSERT_EQ(reset.objects.size(), 2U);
  EXPECT_EQ(reset.objects[1]["refused"], "implausible");
}

TEST_F(DecodeCommand, ReadsAModbusResponseByItsRequestAndProfile) {
  const Arguments vane = {"modbus:renke-rs-fsjt-rs-fxjt-n01", "--hex", "--refused"};
  const std::string speed = "01 03 00 00 00 01 84 0a | 01 03 02 00 56 38 7a\n";
  EXPECT_TRUE(is_value(one(speed, vane)["speed_m_s"], 8.6));
  EXPECT_TRUE(one(speed, vane)["direction_deg"].is_null());
  // Slave 2, register 1: 90 degrees. Over TCP, so without checksums.
  const std::string direction = "00 07 00 00 00 06 02 03 00 01 00 01 | 00 07 00 00 00 05 02 03 02 00 5a\n";
  EXPECT_TRUE(is_value(one(direction, vane)["direction_deg"], 90.0));
  EXPECT_TRUE(is_value(one(speed, {"modbus:renke-rs-fsjt-n01", "--hex"})["speed_m_s"], 8.6));

  EXPECT_EQ(one("01 03 02 00 56 38 7a\n", vane)["refused"], "malformed") << "which register?";
  json late = one("00 07 00 00 00 06 02 03 00 01 00 01 | 00 06 00 00 00 05 02 03 02 00 5a\n", vane);
  EXPECT_EQ(late["refused"], "not mine");
  json other = one("01 03 00 05 00 01 94 0b | 01 03 02 00 56 38 7a\n", vane);
  EXPECT_EQ(other["refused"], "not mine");
  EXPECT_THAT(other["detail"], HasSubstr("registers 0x0005 to 0x0005"));
  EXPECT_EQ(run(speed, {"modbus:renke-rs-fsjt-n01", "--hex", "--speed-slave", "2"}).objects.size(), 0U);
  EXPECT_EQ(run(speed, {"modbus:renke-rs-fsjt-n01", "--hex", "--direction-slave", "2"}).code, kExitConfig);
}

}  // namespace
}  // namespace yuragi::daemon::commands
