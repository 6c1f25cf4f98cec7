// `yuragi decode` as a shell meets it: the program's own command, from files and pipes.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/commands/command.hpp"
#include "daemon/exit.hpp"
#include "daemon/hex_text.hpp"
#include "tests/support/byte_vectors.hpp"
#include "tests/support/child_process.hpp"
#include "tests/support/decoded_text.hpp"
#include "tests/support/places.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi {

extern const Command kDecodeCommand;

namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using Arguments = std::vector<std::string>;

/// What came of a run of the command in this process.
struct DecodeRun {
  std::vector<json> objects;  ///< one a line of its output
  std::string text;           ///< all of it
  std::string error;          ///< what went to standard error, or the message that it ended with
  int code = 0;
};

class DecodeCommand : public ::testing::Test {
 protected:
  DecodeRun run_file(const std::string& file, Arguments arguments) {
    arguments.insert(arguments.begin() + 1, file);
    DecodeRun done;
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    try {
      CLI::App app;
      kDecodeCommand.add(app);
      std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());
      reversed.emplace_back("decode");
      app.parse(reversed);
    } catch (const ExitError& error) {
      done.code = error.code();
      done.error = error.what();
    } catch (const CLI::ParseError& error) {
      done.code = kExitUsage;
      done.error = error.what();
    }
    done.text = testing::internal::GetCapturedStdout();
    done.error += testing::internal::GetCapturedStderr();
    std::istringstream lines(done.text);
    for (std::string line; std::getline(lines, line);) done.objects.push_back(json::parse(line));
    return done;
  }

  DecodeRun run(const std::string& input, const Arguments& arguments) {
    const auto file = folder_ / "input";
    std::ofstream(file, std::ios::binary) << input;
    return run_file(file.string(), arguments);
  }

  /// The one object that comes out of one message.
  json one(const std::string& input, const Arguments& arguments) {
    const DecodeRun done = run(input, arguments);
    EXPECT_EQ(done.code, 0) << done.error;
    EXPECT_EQ(done.objects.size(), 1U) << done.text << done.error;
    return done.objects.empty() ? json::object() : done.objects.front();
  }

  test::TemporaryFolder folder_;
};

/// A number as expected, or null where none is.
testing::AssertionResult is_value(const json& value, std::optional<double> expected, double tolerance = 6e-3) {
  const bool agrees =
      expected ? value.is_number() && std::abs(value.get<double>() - *expected) <= tolerance : value.is_null();
  return agrees ? testing::AssertionSuccess()
                : testing::AssertionFailure() << value << ", not " << testing::PrintToString(expected);
}

// ---- what comes out ----

TEST_F(DecodeCommand, GivesOneObjectAReadingWithNullForWhatIsAbsent) {
  const auto done = run("$WIMWV,214.8,R,10.0,N,A*1D\r\n$WIMWV,,R,3.0,M,A*0D\n", {"nmea"});
  ASSERT_EQ(done.objects.size(), 2U) << done.error;
  EXPECT_EQ(done.text.substr(0, done.text.find('\n')),
            R"({"speed_m_s":5.144444444444445,"direction_deg":214.8,"gust_m_s":null,)"
            R"("reference":"relative","status":"good"})");
  EXPECT_TRUE(is_value(done.objects[1]["speed_m_s"], 3.0));
  EXPECT_TRUE(done.objects[1]["direction_deg"].is_null());
}

TEST_F(DecodeCommand, KeepsTheFullPrecisionOfNumbers) {
  json reading = one("$WIMWV,214.8,R,10.0,K,A*18\n", {"nmea"});
  EXPECT_EQ(reading["speed_m_s"].get<double>(), 10.0 / 3.6);
}

TEST_F(DecodeCommand, LeavesOutAReferenceThatTheSourceDoesNotSay) {
  EXPECT_FALSE(one("4.2,270,6.1\n", {"line"}).contains("reference"));
  EXPECT_EQ(one("$WIMWD,328.2,T,326.8,M,11.2,N,5.8,M*61\n", {"nmea"})["reference"], "north");
  EXPECT_EQ(one("$IIMWD,,,046.,M,10.1,N,05.2,M*0B\n", {"nmea"})["reference"], "magnetic");
  EXPECT_EQ(one("$IIMWV,074,T,05.85,N,A*2E\n", {"nmea"})["reference"], "true");
}

TEST_F(DecodeCommand, TellsOfWhatIsRefusedOnRequestOnly) {
  const std::string input = "# a comment\n!AIVDM,1,1,,A,13u?etPv2;0n:dDPwUM1U1Cb069D,0*24\n$WIMWV,1,R,1,M,A*00\n";
  const auto quiet = run(input, {"nmea"});
  EXPECT_EQ(quiet.code, 0);
  EXPECT_EQ(quiet.text, "");
  EXPECT_THAT(quiet.error, HasSubstr("0 readings; refused: bad checksum 1, not mine 2. --refused shows each"));

  const auto told = run(input, {"nmea", "--refused"});
  EXPECT_EQ(told.code, 0);
  ASSERT_EQ(told.objects.size(), 3U);
  EXPECT_EQ(told.objects[0]["refused"], "not mine");
  EXPECT_EQ(told.text.substr(told.text.rfind("{")),
            "{\"refused\":\"bad checksum\",\"input\":\"$WIMWV,1,R,1,M,A*00\"}\n");
}

TEST_F(DecodeCommand, EscapesInputThatIsNotUtf8AndEveryControlCharacter) {
  const auto done =
      run("$\xff\xfe"
          "A\x1b[31m\n$\xc2\xb0\n",
          {"nmea", "--refused"});
  ASSERT_EQ(done.objects.size(), 2U);
  EXPECT_EQ(done.objects[0]["input"], "$\\xff\\xfeA\x1b[31m");
  EXPECT_EQ(done.objects[1]["input"], "$\xc2\xb0") << "what is UTF-8 stays what it is";
  EXPECT_TRUE(std::ranges::all_of(done.text, [](char c) { return c == '\n' || (c >= 0x20 && c < 0x7F); }))
      << "nothing that a terminal would obey";
}

TEST_F(DecodeCommand, SurvivesALineWithoutEndAndGoesOnBehindIt) {
  const auto done = run(std::string(100'000, 'x') + "\n$WIMWV,214.8,R,10.0,N,A*1D\n", {"nmea", "--refused"});
  ASSERT_EQ(done.objects.size(), 2U) << done.text;
  EXPECT_EQ(done.objects[0]["refused"], "malformed");
  EXPECT_TRUE(is_value(done.objects[1]["speed_m_s"], 5.1444));
  const auto hex =
      run(std::string(100'000, '1') + "\n01 c0 5c 78 00 08 1f 53 03 ff\n", {"acurite", "--hex", "--refused"});
  ASSERT_EQ(hex.objects.size(), 2U);
  EXPECT_EQ(hex.objects[0]["refused"], "malformed");
  EXPECT_TRUE(is_value(hex.objects[1]["speed_m_s"], 0.0));
}

TEST_F(DecodeCommand, ReadsALastLineThatHasNoEnd) {
  EXPECT_TRUE(is_value(one("$WIMWV,214.8,R,10.0,N,A*1D", {"nmea"})["direction_deg"], 214.8));
  EXPECT_TRUE(is_value(one("01 cd ff 71 01 39 39 71 03 ff", {"acurite", "--hex"})["speed_m_s"], 2.8072));
}

// ---- policies and options ----

TEST_F(DecodeCommand, FollowsThePoliciesForAMissingChecksumAndStatus) {
  const std::string bare = "$WIMWV,214.8,R,0.1,K\n";
  EXPECT_TRUE(run(bare, {"nmea"}).objects.empty());
  EXPECT_TRUE(run(bare, {"nmea", "--checksum", "accept"}).objects.empty());
  json reading = one(bare, {"nmea", "--checksum", "accept", "--status", "accept"});
  EXPECT_EQ(reading["status"], "uncertain");
  EXPECT_EQ(one("$WI,WVP=020.0,045,0*//\n", {"ft", "--checksum", "accept"})["speed_m_s"], 20.0);
}

TEST_F(DecodeCommand, ReadsNumbersWhereTheOptionsSayTheyStand) {
  json reading =
      one("17;270;36;-999\n", {"line", "--speed-column", "3", "--direction-column", "2", "--gust-column", "4",
                               "--separator", "semicolon", "--speed-unit", "km/h", "--invalid", "-999"});
  EXPECT_TRUE(is_value(reading["speed_m_s"], 10.0, 1e-9));
  EXPECT_TRUE(is_value(reading["direction_deg"], 270.0));
  EXPECT_TRUE(reading["gust_m_s"].is_null());

  json keys = one("ws=30 wd=4 gust=50\n", {"line", "--speed-key", "ws", "--direction-key", "wd", "--speed-scale", "0.1",
                                           "--direction-scale", "22.5"});
  EXPECT_TRUE(is_value(keys["speed_m_s"], 3.0, 1e-9));
  EXPECT_TRUE(is_value(keys["gust_m_s"], 5.0, 1e-9));
  EXPECT_TRUE(is_value(keys["direction_deg"], 90.0));
}

TEST_F(DecodeCommand, TakesOnlyTheNodeOrDeviceThatIsAskedFor) {
  const std::string gill =
      "\x02Q,229,002.74,M,00,\x03"
      "16\r\n";
  EXPECT_TRUE(is_value(one(gill, {"gill", "--node", "Q"})["speed_m_s"], 2.74));
  EXPECT_TRUE(run(gill, {"gill", "--node", "A"}).objects.empty());
  const std::string umb = "$ 28673 M 00400 32760\n";
  EXPECT_TRUE(is_value(one(umb, {"umb", "--speed-range", "90"})["speed_m_s"], 45.0));
  EXPECT_TRUE(run(umb, {"umb", "--device", "28674"}).objects.empty());
}

TEST_F(DecodeCommand, RefusesAnOptionThatMeansNothingToTheFormat) {
  for (const Arguments& arguments : std::vector<Arguments>{{"nmea", "--node", "Q"},
                                                           {"line", "--checksum", "accept"},
                                                           {"acurite", "--hex", "--slope", "1", "--interval", "1"},
                                                           {"mcc1208", "--hex", "--input", "high-voltage"},
                                                           {"gill", "--speed-slave", "1"}}) {
    const auto done = run("", arguments);
    EXPECT_EQ(done.code, kExitUsage) << arguments[1];
    EXPECT_THAT(done.error, HasSubstr("it is for")) << arguments[1];
  }
}

TEST_F(DecodeCommand, SaysWhatToDoAboutEachMistake) {
  const auto bytes = run("", {"wmr300"});
  EXPECT_EQ(bytes.code, kExitUsage);
  EXPECT_THAT(bytes.error, HasSubstr("--hex"));
  const auto unknown = run("", {"nmea2000"});
  EXPECT_EQ(unknown.code, kExitUsage);
  EXPECT_THAT(unknown.error, HasSubstr("nmea, gill, umb, ft, line"));
  EXPECT_EQ(run("", {"modbus", "--hex"}).code, kExitUsage) << "a profile must be named";
  const auto profile = run("", {"modbus:no-such-device", "--hex"});
  EXPECT_EQ(profile.code, kExitConfig);
  EXPECT_THAT(profile.error, HasSubstr("renke-rs-fsjt-n01"));
  EXPECT_EQ(run("", {"line", "--speed-column", "2"}).code, kExitUsage);
  EXPECT_EQ(run("", {"nmea", "--status", "perhaps"}).code, kExitUsage);
  EXPECT_EQ(run("", {"mcc1208", "--hex", "--slope", "0.5"}).code, kExitUsage) << "a slope alone makes no speed";

  const auto absent = run_file((folder_ / "none.log").string(), {"nmea"});
  EXPECT_EQ(absent.code, kExitNoInput);
  EXPECT_THAT(absent.error, HasSubstr("none.log: No such file"));
  EXPECT_EQ(run_file(folder_.path().string(), {"nmea"}).code, kExitNoInput) << "a folder is no input";
}

// ---- hexadecimal input ----

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
    EXPECT_EQ(done.objects[0]["detail"], "not hexadecimal digits, two a byte") << line;
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
  EXPECT_TRUE(is_value(done.objects[0]["gust_m_s"], 2.2));
}

TEST_F(DecodeCommand, ReadsEachKindOfStationByItsFormat) {
  // A block of 34 bytes at 0x020001: 5a, data, gust 12.3 and speed 8.7 mph, from west, and the exclusive or of all.
  std::vector<std::uint8_t> te923(34, 0x11);
  te923[0] = 0x5A;
  const std::vector<std::uint8_t> wind = {0x23, 0x01, 0x87, 0x00, 0x0C};
  std::ranges::copy(wind, te923.begin() + 26);
  te923[33] = 0;
  for (std::size_t i = 0; i < 33; ++i) te923[33] ^= te923[i];
  json block = one(to_hex(te923) + "\n", {"te923", "--hex"});
  EXPECT_TRUE(is_value(block["speed_m_s"], 8.7 * 0.44704, 1e-9));
  EXPECT_TRUE(is_value(block["gust_m_s"], 12.3 * 0.44704, 1e-9));
  EXPECT_TRUE(is_value(block["direction_deg"], 270.0));

  // Packet d4 of 54 bytes: gust 1.4 m/s, average 2.9 m/s from 13 degrees; the sum of all before at the end.
  std::vector<std::uint8_t> wmr300(54, 0);
  const std::vector<std::uint8_t> head = {0xD4, 0x36, 14, 5, 9, 18, 20, 1, 0, 14, 0, 168, 0, 29, 0, 13};
  std::ranges::copy(head, wmr300.begin());
  unsigned sum = 0;
  for (const std::uint8_t byte : wmr300) sum += byte;
  wmr300[52] = static_cast<std::uint8_t>(sum >> 8U);
  wmr300[53] = static_cast<std::uint8_t>(sum & 0xFFU);
  json packet = one(to_hex(wmr300) + "\n", {"wmr300", "--hex"});
  EXPECT_TRUE(is_value(packet["speed_m_s"], 2.9, 1e-9));
  EXPECT_TRUE(is_value(packet["gust_m_s"], 1.4, 1e-9));
  EXPECT_TRUE(is_value(packet["direction_deg"], 13.0));

  json record = one("05 2d c8 00 3a 78 00 a4 27 2f 48 00 06 00 00 00\n", {"fineoffset", "--hex"});
  EXPECT_TRUE(is_value(record["speed_m_s"], 4.7, 1e-9));
  EXPECT_TRUE(is_value(record["direction_deg"], 135.0));

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
    lines += to_hex(report) + "\n";
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

// ---- counters ----

TEST_F(DecodeCommand, GivesCountsAndVoltsAndTheirMeaningWhereTheOptionsSayIt) {
  auto plain = run("d2 04 00 00\n00 0c\n", {"mcc1208", "--hex"});
  ASSERT_EQ(plain.objects.size(), 2U);
  EXPECT_EQ(plain.objects[0]["count"], 1234);
  EXPECT_TRUE(plain.objects[0]["speed_m_s"].is_null());
  EXPECT_FALSE(plain.objects[0].contains("volts"));
  EXPECT_TRUE(is_value(plain.objects[1]["volts"], 5.0, 1e-9));
  EXPECT_TRUE(plain.objects[1]["direction_deg"].is_null());

  // 20 pulses in 2 s, of 0.7 m each: 7 m/s. Half of a track of 356 degrees: 178.
  auto told = run("d2 04 00 00\ne6 04 00 00\n00 0c\n",
                  {"mcc1208", "--hex", "--slope", "0.7", "--interval", "2", "--vane-reference", "10"});
  ASSERT_EQ(told.objects.size(), 3U);
  EXPECT_TRUE(told.objects[0]["speed_m_s"].is_null()) << "one count is no speed";
  EXPECT_TRUE(is_value(told.objects[1]["speed_m_s"], 7.0, 1e-9));
  EXPECT_TRUE(is_value(told.objects[2]["direction_deg"], 178.0, 1e-9));
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
  json labjack = one(command + to_hex(reply) + "\n", {"labjack", "--hex"});
  EXPECT_EQ(labjack["count"], 1234);
  EXPECT_TRUE(is_value(labjack["direction_deg"], 178.0, 0.01)) << labjack;
  EXPECT_EQ(run(to_hex(reply) + "\n", {"labjack", "--hex"}).objects.size(), 0U) << "what was asked cannot be guessed";
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

// ---- Modbus ----

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

// ---- every vector of ../shared/data that a format covers ----

TEST_F(DecodeCommand, DecodesEverySharedSentence) {
  const auto vectors = shared_json("vectors/nmea_vectors.json");
  if (vectors.is_null()) GTEST_SKIP() << "../shared/data/vectors/nmea_vectors.json is not here";
  for (const auto& vector : vectors) {
    const std::string sentence_text = vector["sentence"];
    SCOPED_TRACE(sentence_text);
    const auto& expect = vector["expect"];
    json decoded = one(sentence_text + "\n", {"nmea", "--refused", "--status", "accept"});
    if (!vector["checksum_ok"]) {
      EXPECT_EQ(decoded["refused"], "bad checksum");
    } else if (expect.contains("drop")) {
      EXPECT_EQ(decoded["refused"], "invalid");
    } else {
      EXPECT_FALSE(decoded.contains("refused")) << decoded;
      if (expect.contains("speed_ms")) {
        EXPECT_TRUE(is_value(decoded["speed_m_s"], expect["speed_ms"].get<double>()));
      }
      const char* direction = expect.contains("angle") ? "angle" : expect.contains("dir_true") ? "dir_true" : "dir_mag";
      if (expect.contains(direction)) {
        EXPECT_TRUE(is_value(decoded["direction_deg"], expect[direction].get<double>()));
      }
      if (expect.contains("ref")) {
        EXPECT_EQ(decoded["reference"], expect["ref"] == "R" ? "relative" : "true");
      }
    }
  }
}

TEST_F(DecodeCommand, DecodesEverySharedGillFrame) {
  const auto vectors = shared_json("vectors/gill_vectors.json");
  if (vectors.is_null()) GTEST_SKIP() << "../shared/data/vectors/gill_vectors.json is not here";
  for (const auto& vector : vectors) {
    const std::string body = vector["body"];
    SCOPED_TRACE(body);
    json decoded = one(vector["frame_hex"].get<std::string>() + "\n", {"gill", "--hex", "--refused"});
    const TextFields fields = split_fields(body, ',');
    if (body.find(",04,") != std::string::npos) {
      EXPECT_EQ(decoded["refused"], "invalid");
      continue;
    }
    EXPECT_TRUE(is_value(decoded["speed_m_s"], std::stod(std::string(fields[2])), 1e-9));
    const bool has_direction = !fields[1].empty() && decoded["speed_m_s"].get<double>() >= 0.05;
    EXPECT_TRUE(is_value(decoded["direction_deg"],
                         has_direction ? std::optional(std::stod(std::string(fields[1]))) : std::nullopt));

    // With the checksum that the manual prints it is read only where that is right.
    const auto printed = run("\x02" + body + "\x03" + vector["printed"].get<std::string>() + "\r\n", {"gill"});
    EXPECT_EQ(printed.objects.size(), vector["printed_is_right"].get<bool>() ? 1U : 0U);
  }
}

TEST_F(DecodeCommand, DecodesEverySharedStationReport) {
  const auto vectors = test::load_byte_vectors("hid_vectors.json", "");
  if (vectors.empty()) GTEST_SKIP() << "../shared/data/vectors/hid_vectors.json is not here";
  const std::map<std::string, std::string> formats = {
      {"WMR100", "wmr100"}, {"WMR300", "wmr300"}, {"AcuRite", "acurite"}, {"Fine Offset", "fineoffset"}};
  std::map<std::string, int> covered;
  for (const auto& vector : vectors) {
    const std::string device = vector["device"];
    const std::string layer = vector.value("layer", "");
    const auto format = std::ranges::find_if(formats, [&](const auto& each) { return device.starts_with(each.first); });
    if (format == formats.end() || !vector.contains("bytes") || !vector.contains("expect")) continue;
    if (layer.find("report") != std::string::npos && layer.starts_with("8-byte")) continue;  // one report of a frame
    if (layer.starts_with("fixed block")) continue;                                          // no wind in it
    SCOPED_TRACE(device + ": " + vector["bytes"].get<std::string>());
    const auto& expect = vector["expect"];
    const auto done = run(vector["bytes"].get<std::string>() + "\n", {format->second, "--hex", "--refused"});
    ASSERT_FALSE(done.objects.empty());
    json decoded = done.objects.front();
    ++covered[format->second];

    const bool has_wind = (expect.contains("avg_ms") && !expect["avg_ms"].is_null()) || expect.value("valid", false);
    if (!has_wind) {
      EXPECT_TRUE(decoded.contains("refused")) << decoded;
      continue;
    }
    const auto number = [&](std::initializer_list<const char*> names) -> std::optional<double> {
      for (const char* name : names) {
        if (expect.contains(name) && !expect[name].is_null()) return expect[name].get<double>();
      }
      return std::nullopt;
    };
    EXPECT_TRUE(is_value(decoded["speed_m_s"], number({"avg_ms", "speed_ms"}), 1e-4));
    EXPECT_TRUE(is_value(decoded["direction_deg"], number({"avg_dir", "dir_deg"}), 1e-9));
    EXPECT_TRUE(is_value(decoded["gust_m_s"], number({"gust_ms"}), 1e-9));
  }
  EXPECT_EQ(covered["wmr300"], 1);
  EXPECT_EQ(covered["fineoffset"], 2);
  EXPECT_GE(covered["acurite"], 9);
  EXPECT_GE(covered["wmr100"], 4);
}

TEST_F(DecodeCommand, DecodesEverySharedCounterReply) {
  const auto vectors = test::load_byte_vectors("usb_vectors.json", "");
  if (vectors.empty()) GTEST_SKIP() << "../shared/data/vectors/usb_vectors.json is not here";
  int covered = 0;
  for (const auto& vector : vectors) {
    if (!vector.contains("reply") || !vector.contains("expect")) continue;
    const std::string device = vector["device"];
    const bool is_labjack = device.starts_with("LabJack");
    json decoded = one(vector["reply"].get<std::string>() + "\n", {is_labjack ? "labjack" : "mcc1208", "--hex"});
    EXPECT_EQ(decoded["count"], vector["expect"][is_labjack ? "counter" : "count"]);
    if (is_labjack) {
      EXPECT_TRUE(is_value(decoded["volts"], vector["expect"]["ain_raw"].get<double>() * 3.7231e-5, 1e-9));
    }
    ++covered;
  }
  EXPECT_EQ(covered, 2);
}

TEST_F(DecodeCommand, DecodesEverySharedModbusExchange) {
  const auto vectors = test::load_byte_vectors("modbus_vectors.json", "");
  if (vectors.empty()) GTEST_SKIP() << "../shared/data/vectors/modbus_vectors.json is not here";

  struct Case {
    Arguments arguments;
    std::string expects_speed;
    std::string expects_direction;
    std::string expects_gust = {};
  };
  // The vane alone is asked as slave 1; beside the cup it is slave 2.
  const std::map<std::string, Case> cases = {
      {"Renke RS-FSJT-N01", {{"modbus:renke-rs-fsjt-n01"}, "wind_speed_ms", ""}},
      {"Renke, answer with a leading", {{"modbus:renke-rs-fsjt-n01"}, "wind_speed_ms", ""}},
      {"DFRobot SEN048", {{"modbus:dfrobot-sen0483"}, "wind_speed_ms", ""}},
      {"Renke RS-FXJT-N01",
       {{"modbus:renke-rs-fsjt-rs-fxjt-n01", "--speed-slave", "9", "--direction-slave", "1"}, "", "wind_dir_deg"}},
      {"Vaisala WM80", {{"modbus:vaisala-wm80"}, "wind_speed_ms", "wind_dir_deg"}},
      {"SenseCAP ONE", {{"modbus:seeed-sensecap-one"}, "ws_avg", "dir_avg", "ws_max"}},
      {"Lufft WS-UMB", {{"modbus:lufft-umb"}, "fast", "", "max"}},
      {"Xunchip", {{"modbus:xunchip-xm8589"}, "wind_speed_raw", ""}},
  };
  int covered = 0;
  for (const auto& vector : vectors) {
    const std::string device = vector["device"];
    SCOPED_TRACE(device);
    const std::string line =
        vector["request"].get<std::string>() + " | " + vector["response"].get<std::string>() + "\n";
    ++covered;
    if (vector["kind"] == "exception") {
      json decoded = one(line, {"modbus:renke-rs-fsjt-n01", "--hex", "--refused"});
      EXPECT_EQ(decoded["refused"], "exception");
      EXPECT_EQ(decoded["detail"], "2, illegal data address");
      continue;
    }
    if (vector["expect"].contains("error")) {
      EXPECT_EQ(one(line, {"modbus:renke-rs-fsjt-n01", "--hex", "--refused"})["refused"], "not mine");
      continue;
    }
    const auto found = std::ranges::find_if(cases, [&](const auto& each) { return device.starts_with(each.first); });
    ASSERT_NE(found, cases.end());
    auto [arguments, speed, direction, gust] = found->second;
    arguments.emplace_back("--hex");
    json decoded = one(line, arguments);
    const auto expected = [&](const std::string& name) {
      const double unit = name == "wind_speed_raw" ? 0.1 : 1.0;
      const bool is_there = !name.empty() && !vector["expect"][name].is_null();
      return is_there ? std::optional(unit * vector["expect"][name].get<double>()) : std::nullopt;
    };
    EXPECT_TRUE(is_value(decoded["speed_m_s"], expected(speed), 1e-9));
    EXPECT_TRUE(is_value(decoded["direction_deg"], expected(direction), 1e-9));
    EXPECT_TRUE(is_value(decoded["gust_m_s"], expected(gust), 1e-9));
  }
  EXPECT_EQ(covered, 10);
}

TEST_F(DecodeCommand, ReadsEveryWindSentenceOfARealVoyageAsGpsdDoes) {
  const std::string log = test::source_path("../shared/data/nmea/gpsd_bundg_zeus_9.log");
  std::ifstream in(log);
  if (!in) GTEST_SKIP() << log << " is not here";
  int sentences = 0;
  for (std::string line; std::getline(in, line);) sentences += line.find("MW") == 3 ? 1 : 0;
  EXPECT_EQ(sentences, 450);

  const auto done = run_file(log, {"nmea"});
  EXPECT_EQ(done.code, 0);
  ASSERT_EQ(done.objects.size(), 450U);

  // gpsd reports the newest once a second, so that its values are among ours, in the same order.
  std::map<std::string, std::vector<json>> by_reference;
  for (const json& reading : done.objects) by_reference[reading["reference"]].push_back(reading);
  std::map<std::string, std::size_t> at;
  const auto follows = [&](const std::string& reference, double speed_m_s, double direction_deg) {
    const auto& readings = by_reference[reference];
    for (std::size_t& i = at[reference]; i < readings.size(); ++i) {
      if (is_value(readings[i]["speed_m_s"], speed_m_s, 0.06) &&
          is_value(readings[i]["direction_deg"], direction_deg, 0.06))
        return true;
    }
    return false;
  };
  std::ifstream gpsd(test::source_path("../shared/data/nmea/gpsd_bundg_zeus_9.tpv_wind.json"));
  int compared = 0;
  for (std::string line; std::getline(gpsd, line);) {
    const json report = json::parse(line);
    if (report.contains("wspeedr")) {
      EXPECT_TRUE(follows("relative", report["wspeedr"], report["wangler"])) << line;
      ++compared;
    }
    if (report.contains("wspeedt")) {
      EXPECT_TRUE(follows("north", report["wspeedt"], report["wanglet"])) << line;
      ++compared;
    }
  }
  EXPECT_GT(compared, 200);
}

TEST_F(DecodeCommand, ReadsALogWithoutStatusFieldsByPolicy) {
  const std::string log = test::source_path("../shared/data/nmea/signalk_n2kd-183-merrimac.log");
  if (!std::ifstream(log)) GTEST_SKIP() << log << " is not here";
  EXPECT_TRUE(run_file(log, {"nmea"}).objects.empty());
  const auto done = run_file(log, {"nmea", "--status", "accept"});
  ASSERT_EQ(done.objects.size(), 147U);
  EXPECT_TRUE(is_value(done.objects[0]["speed_m_s"], 1.89 * 1852.0 / 3600.0, 1e-9));
  EXPECT_TRUE(is_value(done.objects[0]["direction_deg"], 327.6, 1e-9));
  for (const json& reading : done.objects) EXPECT_EQ(reading["status"], "uncertain");
}

// ---- the program ----

TEST(DecodeProgram, AnswersEachLineOfAnEndlessInputAtOnce) {
  ChildProcess program({test::built_path("bin/yuragi"), "decode", "nmea"});
  for (int i = 0; i < 3; ++i) {
    program.type("$WIMWV,214.8,R,10.0,N,A*1D");
    EXPECT_THAT(program.line_after("{\"speed_m_s\":"), HasSubstr("\"direction_deg\":214.8"));
  }
  program.close_input();
  EXPECT_EQ(program.wait(), 0);
}

TEST(DecodeProgram, EndsWithZeroWhateverWasRefusedAndWith66WithoutInput) {
  ChildProcess program({test::built_path("bin/yuragi"), "decode", "nmea", "-"});
  program.type("no sentence at all");
  program.close_input();
  EXPECT_THAT(program.rest(), HasSubstr("0 readings; refused: not mine 1"));
  EXPECT_EQ(program.wait(), 0);

  ChildProcess lost({test::built_path("bin/yuragi"), "decode", "nmea", "/nowhere/none.log"});
  EXPECT_THAT(lost.rest(), HasSubstr("cannot read /nowhere/none.log"));
  EXPECT_EQ(lost.wait(), 66);
}

TEST(DecodeProgram, SaysSoWhereItsOutputCannotBeWritten) {
  const std::string program = test::built_path("bin/yuragi");
  ChildProcess full({"sh", "-c", "echo '$WIMWV,214.8,R,10.0,N,A*1D' | '" + program + "' decode nmea - >/dev/full"});
  EXPECT_THAT(full.rest(), HasSubstr("cannot write to standard output"));
  EXPECT_EQ(full.wait(), kExitCannotCreate);
}

TEST(DecodeProgram, HelpsWithAnExampleOfEachFormat) {
  ChildProcess program({test::built_path("bin/yuragi"), "decode", "--help"});
  const std::string help = program.rest();
  EXPECT_EQ(program.wait(), 0);
  for (const char* name : {"nmea", "gill", "umb", "ft", "line", "wmr100", "wmr300", "fineoffset", "acurite", "te923",
                           "mcc1208", "labjack", "modbus:"}) {
    EXPECT_THAT(help, HasSubstr(std::string("yuragi decode ") + name));
  }
}

}  // namespace
}  // namespace yuragi
