#include "daemon/settings/config_edit.hpp"

#include <random>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/settings/config.hpp"

namespace yuragi::daemon::settings {
namespace {

using ::testing::HasSubstr;

const std::vector<ConfigChange> kGainAndOffset = {{"calibration", "gain", 1.043}, {"calibration", "offset", -0.12}};

std::string edited(std::string_view text, const std::vector<ConfigChange>& changes = kGainAndOffset,
                   std::string_view sensor = "roof") {
  const auto result = edit_sensor(text, sensor, changes);
  return result ? *result : "failure: " + result.error().message;
}

TEST(ConfigEdit, ChangesValuesWhereTheyStandAndLeavesTheRest) {
  EXPECT_EQ(edited("# the wall of the foyer\n"
                   "[[sensor]]\n"
                   "driver = \"modbus\"   # Renke\n"
                   "name   = 'roof'\n"
                   "\n"
                   "  [sensor.calibration]   # by Aya, in March\n"
                   "  offset = +0.0e0        # m/s\n"
                   "  gain   = 1             # from the certificate\n"
                   "\n"
                   "[[scene]]\n"
                   "kind = \"grass\"\n"),
            "# the wall of the foyer\n"
            "[[sensor]]\n"
            "driver = \"modbus\"   # Renke\n"
            "name   = 'roof'\n"
            "\n"
            "  [sensor.calibration]   # by Aya, in March\n"
            "  offset = -0.12        # m/s\n"
            "  gain   = 1.043             # from the certificate\n"
            "\n"
            "[[scene]]\n"
            "kind = \"grass\"\n");
}

TEST(ConfigEdit, AddsAKeyBehindTheOthersOfItsTable) {
  EXPECT_EQ(edited("[[sensor]]\ndriver = \"x\"\nname = \"roof\"\n[sensor.calibration]\n\tgain = 2 # twice\n\n# end\n"),
            "[[sensor]]\ndriver = \"x\"\nname = \"roof\"\n[sensor.calibration]\n\tgain = 1.043 # twice\n"
            "\toffset = -0.12\n\n# end\n");
  EXPECT_EQ(edited("[[sensor]]\nname = \"roof\"\n[sensor.calibration] # nothing yet"),
            "[[sensor]]\nname = \"roof\"\n[sensor.calibration] # nothing yet\ngain = 1.043\noffset = -0.12");
}

TEST(ConfigEdit, AddsTheTableWhereItIsMissing) {
  EXPECT_EQ(edited("  [[sensor]]\n  name = \"roof\"\n  # port = 502\n\n# The scenes\n[[scene]]\nkind = \"grass\"\n"),
            "  [[sensor]]\n  name = \"roof\"\n  # port = 502\n  [sensor.calibration]\n  gain = 1.043\n"
            "  offset = -0.12\n\n# The scenes\n[[scene]]\nkind = \"grass\"\n");
  EXPECT_EQ(edited("[[sensor]]\nname = \"roof\"\n# The scenes\n[[scene]]\nkind = \"grass\"\n"),
            "[[sensor]]\nname = \"roof\"\n[sensor.calibration]\ngain = 1.043\noffset = -0.12\n"
            "# The scenes\n[[scene]]\nkind = \"grass\"\n");
  EXPECT_EQ(edited("[[sensor]]\nname = \"roof\""),
            "[[sensor]]\nname = \"roof\"\n[sensor.calibration]\ngain = 1.043\noffset = -0.12");
}

TEST(ConfigEdit, WritesIntoInlineTables) {
  EXPECT_EQ(edited("[[sensor]]\nname = \"roof\"\ncalibration = { gain = 2 }  # short\nport = 1\n"),
            "[[sensor]]\nname = \"roof\"\ncalibration = { gain = 1.043, offset = -0.12 }  # short\nport = 1\n");
  EXPECT_EQ(edited("[[sensor]]\nname = \"roof\"\ncalibration = {}\n"),
            "[[sensor]]\nname = \"roof\"\ncalibration = { gain = 1.043, offset = -0.12}\n");
  EXPECT_EQ(
      edited("sensor = [ { name = \"a\" },\n  { name = \"roof\", calibration = { offset = 3 } } ] # both\n"),
      "sensor = [ { name = \"a\" },\n  { name = \"roof\", calibration = { offset = -0.12, gain = 1.043 } } ] # both\n");
  EXPECT_EQ(edited("sensor = [ { name = \"roof\" } ]\n"),
            "sensor = [ { name = \"roof\", calibration.gain = 1.043, calibration.offset = -0.12 } ]\n");
}

TEST(ConfigEdit, WritesDottedKeysBesideDottedKeys) {
  EXPECT_EQ(edited("[[sensor]]\n  calibration.offset = 1 # m/s\n  name = \"roof\"\n"),
            "[[sensor]]\n  calibration.offset = -0.12 # m/s\n  calibration.gain = 1.043\n  name = \"roof\"\n");
  EXPECT_EQ(edited("[[sensor]]\nname = \"roof\"\n\"calibration\" . height = 4\n"),
            "[[sensor]]\nname = \"roof\"\n\"calibration\" . height = 4\ncalibration.gain = 1.043\n"
            "calibration.offset = -0.12\n");
}

TEST(ConfigEdit, KeepsLineEndsMarksAndForeignLetters) {
  EXPECT_EQ(edited("\xEF\xBB\xBF# d\xC3\xA9j\xC3\xA0\r\n[[sensor]]\r\nname = \"roof\" # \xE9\xA2\xA8\r\n"
                   "calibration = { curve = \"\xC3\xA9\", gain = 2 } # \xE9\xA2\xA8\r\n"),
            "\xEF\xBB\xBF# d\xC3\xA9j\xC3\xA0\r\n[[sensor]]\r\nname = \"roof\" # \xE9\xA2\xA8\r\n"
            "calibration = { curve = \"\xC3\xA9\", gain = 1.043, offset = -0.12 } # \xE9\xA2\xA8\r\n");
  EXPECT_EQ(edited("[[sensor]]\r\nname = \"roof\"\r\n[sensor.calibration]\r\ngain = 2\r\n"),
            "[[sensor]]\r\nname = \"roof\"\r\n[sensor.calibration]\r\ngain = 1.043\r\noffset = -0.12\r\n");
  EXPECT_EQ(edited("\xEF\xBB\xBFsensor = [{name=\"roof\",calibration={gain=2,offset=3}}]"),
            "\xEF\xBB\xBFsensor = [{name=\"roof\",calibration={gain=1.043,offset=-0.12}}]");
}

TEST(ConfigEdit, ReplacesTextsOfEveryKind) {
  const std::vector<ConfigChange> curve = {{"calibration", "curve", std::string("0:0 5:5.2")}};
  for (const char* old : {"\"0:0 1:1\"", "'0:0 1:1'", "\"\"\"0:0\n 1:1\"\"\"", "'''\n0:0 1:1'''", "\"\""}) {
    EXPECT_EQ(
        edited("[[sensor]]\nname = \"roof\"\n[sensor.calibration]\ncurve = " + std::string(old) + " # x\ngain = 2\n",
               curve),
        "[[sensor]]\nname = \"roof\"\n[sensor.calibration]\ncurve = \"0:0 5:5.2\" # x\ngain = 2\n");
  }
}

TEST(ConfigEdit, FindsTheSensorAmongOthersByNameOrDriver) {
  const std::string two = "[[sensor]]\ndriver = \"nmea\"\n[[sensor]]\ndriver = \"nmea\"\nname = \"roof\"\n";
  const std::vector<ConfigChange> north = {{"calibration", "north_offset", 12.5}};
  EXPECT_EQ(edited(two, north, "nmea"),
            "[[sensor]]\ndriver = \"nmea\"\n[sensor.calibration]\nnorth_offset = 12.5\n"
            "[[sensor]]\ndriver = \"nmea\"\nname = \"roof\"\n");
  EXPECT_EQ(edited(two, north, "roof"), two + "[sensor.calibration]\nnorth_offset = 12.5\n");
  EXPECT_THAT(edited(two, north, "mast"), HasSubstr("no [[sensor]] named \"mast\""));
  EXPECT_THAT(edited("", north, "synthetic"), HasSubstr("no [[sensor]]"));
}

TEST(ConfigEdit, ChangesADriversOwnParametersToo) {
  EXPECT_EQ(edited("[[sensor]]\ndriver = \"microphone\" # two\ngain = 20.0\nname = "
                   "\"roof\"\n\n[sensor.calibration]\ngain = 2.0\n",
                   {{"", "gain", 31.5}, {"", "exponent", 1.8}, {"calibration", "gain", 1.0}}),
            "[[sensor]]\ndriver = \"microphone\" # two\ngain = 31.5\nname = \"roof\"\nexponent = "
            "1.8\n\n[sensor.calibration]\n"
            "gain = 1.0\n");
}

TEST(ConfigEdit, RefusesWhatItCannotProve) {
  EXPECT_THAT(edited("[[sensor]\n"), HasSubstr("TOML: "));
  EXPECT_THAT(edited("[[sensor]]\nname = \"roof\"\ncalibration = 3\n"), HasSubstr("calibration.gain = 1.043"));
  EXPECT_THAT(edited("[sensor]\nname = \"roof\"\n"), HasSubstr("no [[sensor]]"));
}

TEST(ConfigEdit, NumbersAreWrittenInTheFewestDigits) {
  EXPECT_EQ(toml_value(0.1), "0.1");
  EXPECT_EQ(toml_value(2.0), "2.0");
  EXPECT_EQ(toml_value(-12.0), "-12.0");
  EXPECT_EQ(toml_value(1e-7), "1e-07");
  EXPECT_EQ(toml_value(std::int64_t{3}), "3");
  EXPECT_EQ(toml_value(true), "true");
  EXPECT_EQ(toml_value(std::string("a\\b")), "'a\\b'");
}

// ---- any layout ----

/// A configuration of three sensors in a random layout; every part of it is one that people write.
std::string random_config(std::mt19937_64& random) {
  const auto one_of = [&random](std::initializer_list<const char*> words) {
    return std::string(words.begin()[random() % words.size()]);
  };
  const std::string end = one_of({"\n", "\r\n"});
  const auto line = [&](const std::string& content) {
    return one_of({"", "", " ", "\t", "    "}) + content + one_of({"", " ", " # note", "\t# \xE9\xA2\xA8 = [x]"}) + end;
  };
  const auto blank = [&] { return one_of({"", "", "\n", "# a comment\n", "\n# another\n\n"}); };
  const auto value = [&] { return one_of({"1", "2.5", "+0.75", "1e0", "1_0.5"}); };

  std::string text = one_of({"", "\xEF\xBB\xBF", "# head\n", "seed = 3\n"});
  for (const char* name : {"mast", "roof", "wall"}) {
    text += blank() + line(one_of({"[[sensor]]", "[[ sensor ]]", "[['sensor']]"}));
    std::vector<std::string> lines = {line("driver = \"synthetic\""),
                                      line("name = " + ("\"" + std::string(name) + "\""))};
    if (random() % 2 == 0) lines.push_back(line("speed=" + value()));
    const auto form = random() % 5;
    if (form == 0)
      lines.push_back(line("calibration = {" + one_of({"", " gain = 1 ", "gain=1,offset=0.5", "height = 3"}) + "}"));
    if (form == 1) {
      lines.push_back(
          line(one_of({"calibration.gain = ", "calibration . gain = ", "\"calibration\".gain="}) + value()));
      if (random() % 2 == 0) lines.push_back(line("calibration.offset = " + value()));
    }
    std::ranges::shuffle(lines, random);
    for (const std::string& one : lines) text += one + one_of({"", "", "# between\n"});
    if (form == 2) {
      text += blank() + line(one_of({"[sensor.calibration]", "[ sensor . \"calibration\" ]"}));
      if (random() % 2 == 0) text += line("gain = " + value());
      if (random() % 2 == 0) text += line("curve = " + one_of({"\"\"", "'0:0 5:6'", "\"\"\"0:0 \\\n 5:6\"\"\""}));
      if (random() % 2 == 0) text += line("offset = " + value());
    }
  }
  if (random() % 2 == 0) text += blank() + "[[scene]]" + end + "kind = \"grass\"";
  if (random() % 2 == 0) {
    while (text.ends_with('\n') || text.ends_with('\r')) text.pop_back();
  }
  return text;
}

/// The lines of a text, with what may differ between them left in.
std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines(1);
  for (const char sign : text) {
    if (sign == '\n') {
      lines.emplace_back();
    } else if (sign != '\r') {
      lines.back() += sign;
    }
  }
  return lines;
}

TEST(ConfigEdit, AnyLayoutIsChangedOnlyWhereItShould) {
  std::mt19937_64 random(11);
  for (int round = 0; round < 200; ++round) {
    const std::string text = random_config(random);
    SCOPED_TRACE(text);
    const std::vector<ConfigChange> changes = {{"calibration", "gain", 1.043},
                                               {"calibration", "offset", -0.12},
                                               {"calibration", "curve", std::string("0:0 6:7")},
                                               {"", "speed", 7.5}};
    const auto result = edit_sensor(text, "roof", changes);
    ASSERT_TRUE(result) << result.error().message;

    // Everything is as it was but for these values.
    Config expected = parse_config(text, "wall.toml");
    for (SensorConfig& sensor : expected.sensors) {
      if (sensor.name != "roof") continue;
      for (const ConfigChange& change : changes) {
        (change.table.empty() ? sensor.values : sensor.by_name.at("calibration")).set(change.key, change.value);
      }
    }
    ASSERT_EQ(to_toml(parse_config(*result, "wall.toml")), to_toml(expected));

    // Every line that says nothing of them is there still, in its order.
    const std::vector<std::string> after = lines_of(*result);
    auto from = after.begin();
    for (const std::string& line : lines_of(text)) {
      const bool is_touched = line.find("gain") != std::string::npos || line.find("offset") != std::string::npos ||
                              line.find("curve") != std::string::npos || line.find("speed") != std::string::npos ||
                              line.find("calibration = {") != std::string::npos ||
                              line.find("5:6") != std::string::npos;
      if (is_touched) continue;
      from = std::find(from, after.end(), line);
      ASSERT_NE(from, after.end()) << "lost: " << line;
      ++from;
    }
    EXPECT_EQ(edit_sensor(*result, "roof", changes).value(), *result) << "a second time it changes nothing";
  }
}

}  // namespace
}  // namespace yuragi::daemon::settings
