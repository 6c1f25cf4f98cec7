// `yuragi decode` as a shell meets it: the program's own command, from files and pipes.
#include <algorithm>
#include <fstream>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/commands/decode_options.hpp"
#include "daemon/tools/decode/hex_text.hpp"
#include "drivers/sensor/driver.hpp"
#include "drivers/text/nmea_sensor.hpp"
#include "tests/daemon/commands/decode_run.hpp"
#include "tests/support/child_process.hpp"
#include "tests/support/manual_clock.hpp"
#include "tests/support/places.hpp"
#include "tests/support/recording_sink.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::daemon::commands {
namespace {

using Arguments = std::vector<std::string>;
using nlohmann::json;
using ::testing::HasSubstr;

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
  EXPECT_THAT(quiet.error, HasSubstr("0 readings; refused: bad checksum 1, not mine 2; --refused shows each"));

  const auto received = run(input, {"nmea", "--refused"});
  EXPECT_EQ(received.code, 0);
  ASSERT_EQ(received.objects.size(), 3U);
  EXPECT_EQ(received.objects[0]["refused"], "not mine");
  EXPECT_EQ(received.text.substr(received.text.rfind("{")),
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

TEST_F(DecodeCommand, FollowsThePoliciesForAMissingChecksumAndStatus) {
  const std::string bare = "$WIMWV,214.8,R,0.1,K\n";
  EXPECT_EQ(one(bare, {"nmea"})["status"], "uncertain") << "as the driver takes it from a file";
  EXPECT_TRUE(run(bare, {"nmea", "--checksum", "refuse"}).objects.empty());
  EXPECT_TRUE(run(bare, {"nmea", "--status", "refuse"}).objects.empty());
  EXPECT_EQ(one(bare, {"nmea", "--checksum", "accept", "--status", "accept"})["status"], "uncertain");
  EXPECT_TRUE(run("$WI,WVP=020.0,045,0*//\n", {"ft"}).objects.empty()) << "the makers' formats always have one";
  EXPECT_EQ(one("$WI,WVP=020.0,045,0*//\n", {"ft", "--checksum", "accept"})["speed_m_s"], 20.0);
}

const drivers::sensor::DriverDescription& driver_named(std::string_view name) {
  return **std::ranges::find(drivers::sensor::driver_table(), name,
                             [](const drivers::sensor::DriverDescription* driver) { return driver->name; });
}

TEST_F(DecodeCommand, HasTheDefaultsOfTheDriverOfText) {
  const auto values = ParameterValues::resolve(driver_named("nmea").parameters,
                                               {{"transport", std::string("file")}, {"file", std::string("a.log")}});
  ASSERT_TRUE(values);
  const auto driver = drivers::text::nmea_sensor_settings_of(*values);
  const auto expect_alike = [&](const tools::decode::UnitDecoderOptions& options) {
    EXPECT_EQ(options.checksum, driver.checksum);
    EXPECT_EQ(options.makers_checksum, driver.makers_checksum);
    EXPECT_EQ(options.status, driver.status);
    EXPECT_EQ(options.xdr_first_id, driver.xdr_first_id);
    EXPECT_EQ(options.umb_speed_range_m_s, driver.speed_range_m_s);
    EXPECT_FALSE(options.node.has_value()) << "the driver's talker is empty: any";
    EXPECT_FALSE(options.umb_device.has_value());
  };
  expect_alike({});

  // And as the command line leaves them.
  CLI::App app;
  DecodeCommandOptions options;
  options.add_to(app);
  app.parse(std::vector<std::string>{"nmea"});
  options.check();
  expect_alike(options.decoder);
}

TEST_F(DecodeCommand, HasTheDefaultsAndLimitsOfTheDriverOfCounters) {
  const auto driver = ParameterValues::resolve(driver_named("usb").parameters, {});
  ASSERT_TRUE(driver);
  CLI::App app;
  DecodeCommandOptions options;
  options.add_to(app);
  for (const auto& decoder : {options.decoder, tools::decode::UnitDecoderOptions{}}) {
    EXPECT_EQ(decoder.cup.metres_per_pulse, driver->number("metres_per_pulse"));
    EXPECT_EQ(decoder.cup.offset_m_s, driver->number("offset"));
    EXPECT_EQ(decoder.cup.enough_pulses, driver->integer("window_pulses"));
    EXPECT_EQ(decoder.cup.longest_window_s, driver->number("window"));
    EXPECT_EQ(decoder.vane.start_deg, driver->number("vane_start"));
    EXPECT_EQ(decoder.vane.electrical_deg, driver->number("vane_span"));
    EXPECT_EQ(decoder.vane.lowest_ratio, driver->number("vane_lowest"));
    EXPECT_EQ(decoder.vane.highest_ratio, driver->number("vane_highest"));
  }
  for (const auto& [option, parameter] : std::map<std::string, std::string>{
           {"--slope", "metres_per_pulse"}, {"--offset", "offset"}, {"--vane-reference", "reference_voltage"}}) {
    const auto& table = driver_named("usb").parameters;
    const auto found = std::ranges::find(table, parameter, &Parameter::name);
    ASSERT_NE(found, table.end());
    for (const double value : {found->min, found->max, found->min - 0.1, found->max + 0.1}) {
      const bool is_within = value >= found->min && value <= found->max;
      const auto done = run("", {"mcc1208", "--hex", "--interval", "1", option + "=" + std::to_string(value)});
      EXPECT_EQ(done.code == 0, is_within) << option << " " << value << ": " << done.error;
    }
  }
}

/// What the driver itself makes of a file with one message.
std::vector<wind::Reading> of_driver(const std::string& format, const std::string& message) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "a.log", std::ios::binary) << message;
  const auto values = ParameterValues::resolve(driver_named("nmea").parameters, {{"format", format},
                                                                                 {"transport", std::string("file")},
                                                                                 {"file", (folder / "a.log").string()},
                                                                                 {"play_rate", 10.0}});
  const auto sensor = driver_named("nmea").open(values.value());
  ManualClock clock;
  RecordingSink sink;
  for (int polls = 0; polls < 100; ++polls) clock.advance_to(sensor->poll(clock, sink));
  return sink.readings;
}

TEST_F(DecodeCommand, TakesAndRefusesWhatTheDriverTakesAndRefusesFromAFile) {
  const std::vector<std::pair<std::string, std::string>> messages = {
      {"nmea", "$WIMWV,214.8,R,10.0,N,A*1D"},
      {"nmea", "$WIMWV,214.8,R,10.0,N,A"},     // without a checksum
      {"nmea", "$WIMWV,214.8,R,10.0,N,A*00"},  // with a wrong one
      {"nmea", "$WIMWV,214.8,R,10.0,N"},       // without a status
      {"nmea", "$WIMWV,214.8,R,10.0,N,V"},
      {"nmea", "$WIXDR,A,30,D,0,S,5.0,M,0"},
      {"nmea", "$WIXDR,A,30,D,4,S,5.0,M,4"},  // another device's
      {"gill",
       "\x02Q,229,002.74,M,00,\x03"
       "16"},
      {"gill", "Q,229,002.74,M,00,"},  // without a checksum
      {"gill",
       "\x02Q,229,002.74,M,,\x03"
       "16"},
      {"ft", "$WI,WVP=020.0,045,0*73"},
      {"ft", "$WI,WVP=020.0,045,0*//"},
      {"ft", "$WI,WVP=020.0,045,0"},
      {"umb", "$WIMWV,214.8,R,10.0,N,A*1D"},
      {"umb", "$WIMWV,214.8,R,10.0,N,A"},
      {"umb", "$ 28673 M 00400 32760"}};
  int taken = 0;
  for (const auto& [format, message] : messages) {
    SCOPED_TRACE(testing::Message() << format << ": " << message);
    const auto readings = of_driver(format, message + "\r\n");
    const auto done = run(message + "\r\n", {format});
    ASSERT_EQ(done.objects.size(), readings.size()) << done.error;
    if (readings.empty()) continue;
    ++taken;
    EXPECT_TRUE(is_value(done.objects[0]["speed_m_s"], readings[0].speed_m_s));
    EXPECT_EQ(done.objects[0]["status"] == "good", readings[0].quality == wind::ReadingQuality::kGood);
  }
  EXPECT_GE(taken, 7);
  EXPECT_LE(taken, 10);
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

TEST_F(DecodeCommand, DecodesTheLinesOfABusByTheirLook) {
  const std::string lines =
      "17:33:21.179 R 09FD0205 64 1E 01 C8 F1 FA FF FF\r\n"
      "(1436509052.249713) can0 09FD0205#641E01C8F1FAFFFF\n"
      "  can0  20000040   [8]  00 00 00 00 00 00 00 00   ERRORFRAME\n"
      "{\"version\":\"4.12.0\",\"units\":\"std\"}\n"
      R"({"src":5,"pgn":130306,"fields":{"list":")" +
      std::string(4000, 'x') + R"(","Wind Speed":2.86,"Wind Angle":2.0,"Reference":"Apparent"}})" + "\n";
  auto done = run(lines, {"nmea2000", "--refused"});
  ASSERT_EQ(done.objects.size(), 5U) << done.text;
  for (const std::size_t wind : {0U, 1U, 4U}) {
    EXPECT_TRUE(is_value(done.objects[wind]["speed_m_s"], 2.86, 1e-9));
    EXPECT_EQ(done.objects[wind]["reference"], "relative");
  }
  EXPECT_TRUE(is_value(done.objects[1]["direction_deg"], 354.638, 1e-3));
  EXPECT_TRUE(is_value(done.objects[4]["direction_deg"], 2.0)) << "its first line says degrees";
  EXPECT_EQ(done.objects[2]["refused"], "exception");
  EXPECT_EQ(done.objects[3]["refused"], "not mine");

  const std::string unsaid = R"({"src":5,"pgn":130306,"fields":{"Wind Speed":2.86,"Wind Angle":2.0}})";
  EXPECT_TRUE(one(unsaid, {"nmea2000"})["direction_deg"].is_null());
  EXPECT_TRUE(is_value(one(unsaid, {"nmea2000", "--angle-unit", "rad"})["direction_deg"], 114.592, 1e-3));
  EXPECT_EQ(run(unsaid, {"nmea2000", "--angle-unit", "grad"}).code, kExitUsage);
}

TEST_F(DecodeCommand, DecodesWhatEachSignalKDeltaSays) {
  const auto delta = [](const std::string& values) {
    return R"({"context":"vessels.self","updates":[{"$source":"n2k.105","values":[)" + values + "]}]}\n";
  };
  const auto value = [](const std::string& name, const std::string& number) {
    return R"({"path":"environment.wind.)" + name + R"(","value":)" + number + "}";
  };
  auto done = run(delta(value("speedApparent", "4.01") + "," + value("angleApparent", "-0.5")) +
                      delta(value("angleTrueWater", "0.5")) + delta(value("speedTrue", "2.5")),
                  {"signalk"});
  ASSERT_EQ(done.objects.size(), 3U) << done.text;
  EXPECT_TRUE(is_value(done.objects[0]["speed_m_s"], 4.01));
  EXPECT_TRUE(is_value(done.objects[0]["direction_deg"], 331.352, 1e-3));
  EXPECT_EQ(done.objects[0]["reference"], "relative");
  EXPECT_TRUE(done.objects[1]["speed_m_s"].is_null());
  EXPECT_TRUE(is_value(done.objects[1]["direction_deg"], 28.648, 1e-3));
  EXPECT_EQ(done.objects[1]["reference"], "true");
  EXPECT_TRUE(is_value(done.objects[2]["speed_m_s"], 2.5));
  auto hello = run(R"({"name":"s","version":"2.0","roles":["master"]})", {"signalk", "--refused"});
  EXPECT_EQ(hello.objects.at(0)["refused"], "not mine");
}

TEST_F(DecodeCommand, RefusesAnOptionThatMeansNothingToTheFormat) {
  for (const Arguments& arguments : std::vector<Arguments>{{"nmea", "--node", "Q"},
                                                           {"line", "--checksum", "accept"},
                                                           {"acurite", "--hex", "--slope", "1", "--interval", "1"},
                                                           {"mcc1208", "--hex", "--input", "high-voltage"},
                                                           {"nmea", "--angle-unit", "rad"},
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
  const auto unknown = run("", {"nmea3000"});
  EXPECT_EQ(unknown.code, kExitUsage);
  EXPECT_THAT(unknown.error, HasSubstr("nmea, gill, umb, ft, wxt, line, nmea2000, signalk"));
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
  for (const char* name : {"nmea",    "gill",         "umb",        "ft",      "wxt",     "line",        "wmr100",
                           "wmr300",  "fineoffset",   "acurite",    "te923",   "davis",   "weatherlink", "tempest",
                           "ecowitt", "ecowitt-push", "umb-binary", "mcc1208", "labjack", "modbus:"}) {
    EXPECT_THAT(help, HasSubstr(std::string("yuragi decode ") + name));
  }
}

}  // namespace
}  // namespace yuragi::daemon::commands
