#include "daemon/settings/page_file.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/settings/reload_plan.hpp"
#include "daemon/settings/secret_exposure.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::daemon::settings {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

constexpr const char* kRoof =
    "[[sensor]]\nname = \"roof\"\ndriver = \"nmea\"\ntransport = \"tcp\"\nhost = \"127.0.0.1\"\nport = 4001\n";

std::string refusal_of(const std::string& page, const Config& config = default_config()) {
  try {
    with_page_checked(config, page, "page.toml");
    return "";
  } catch (const ConfigError& error) {
    return error.what();
  }
}

std::vector<std::string> names_in(const Config& config) {
  std::vector<std::string> names;
  for (const SensorConfig& sensor : config.sensors) names.push_back(sensor.name);
  return names;
}

bool is_free_text(const Parameter& key) {
  const bool is_text =
      std::holds_alternative<std::string>(key.default_value) || std::holds_alternative<Secret>(key.default_value);
  return is_text && key.choices.empty();
}

std::string page_with(std::string_view driver, std::string_view key, std::string_view value) {
  return fmt::format("[[sensor]]\nname = \"a\"\ndriver = \"{}\"\n{} = \"{}\"\n", driver, key, value);
}

TEST(PageFile, ItsSensorsAreTheLast_AndReplaceTheSyntheticOneOfAFileWithoutAny) {
  EXPECT_THAT(names_in(with_page(default_config(), kRoof, "page.toml")), ElementsAre("roof"));
  const Config two = parse_config("[[sensor]]\nname = \"mast\"\ndriver = \"synthetic\"\n", "a.toml");
  EXPECT_THAT(names_in(with_page(two, kRoof, "page.toml")), ElementsAre("mast", "roof"));
  EXPECT_THAT(names_in(with_page(default_config(), "", "page.toml")), ElementsAre("synthetic"));
}

TEST(PageFile, AMistakeIsToldWithItsFileAndLine) {
  const Config roof = parse_config("[[sensor]]\nname = \"roof\"\ndriver = \"synthetic\"\n", "a.toml");
  EXPECT_THAT(refusal_of(kRoof, roof), HasSubstr("page.toml:2:8: sensor.name: \"roof\" is in use"));
  EXPECT_THAT(refusal_of("[[sensor]]\ndriver = \"nmea\"\nport = 0\n"), StartsWith("page.toml:3:8: sensor.port: is 0"));
  EXPECT_THAT(refusal_of(std::string(kRoof) + kRoof), HasSubstr("is used twice"));
  EXPECT_THAT(refusal_of("[[sensor]"), StartsWith("page.toml:1:"));
}

TEST(PageFile, NothingBesideSensorsCalibrationsAndValuesIsRead) {
  for (const char* const hostile :
       {"seed = 2\n", "[http]\nlisten = \"0.0.0.0:80\"\n", "[[alert]]\nname = \"a\"\ncommand = \"true\"\n",
        "[recording]\nfile = \"/tmp/a.windlog\"\n", "[[output]]\n", "sensor = 1\n", "[sensor]\ndriver = \"nmea\"\n"}) {
    EXPECT_NE(refusal_of(hostile), "") << hostile;
  }
}

/// A text of a new key is refused until somebody decides: here, or in page_file.cpp.
TEST(PageFile, EachTextThatCanNameAFileOrAProgramIsRefused) {
  const std::set<std::string> kRefused = {
      "json.ca_file",       "json.headers_file",  "line.file",         "line.request",       "microphone.worker",
      "modbus.profile_dir", "mqtt.ca_file",       "mqtt.password_env", "mqtt.password_file", "nmea.file",
      "nmea.request",       "nmea2000.file",      "nmea2000.request",  "signalk.file",       "signalk.request",
      "signalk.token_env",  "signalk.token_file", "windlog.file",      "windlog.sensor",     "windlog.start",
      "windlog.utc_offset"};
  std::set<std::string> refused;
  for (const auto* driver : drivers::sensor::driver_table()) {
    for (const Parameter& key : driver->parameters) {
      if (!is_free_text(key)) continue;
      const std::string name = fmt::format("{}.{}", driver->name, key.name);
      if (!page_refusal(*driver, key)) continue;
      refused.insert(name);
      EXPECT_THAT(refusal_of(page_with(driver->name, key.name, "a")), HasSubstr(std::string(key.name))) << name;
    }
  }
  EXPECT_EQ(refused, kRefused);
}

TEST(PageFile, NoKeyWhoseNameOrHelpSpeaksOfAFileIsTakenAsItIs) {
  for (const auto* driver : drivers::sensor::driver_table()) {
    for (const Parameter& key : driver->parameters) {
      const std::string name(key.name);
      const bool is_suspect = key.is_secret_file || key.takes_control_characters || name.find("file") != name.npos ||
                              name.find("dir") == 0 || name.find("device") != name.npos ||
                              name.find("env") != name.npos;
      const bool is_harmless = driver->name == "microphone" || name.starts_with("direction");
      if (!is_free_text(key) || !is_suspect || (is_harmless && name != "direction_device")) continue;
      EXPECT_THAT(refusal_of(page_with(driver->name, key.name, "/etc/passwd")), HasSubstr(name)) << driver->name;
    }
  }
}

TEST(PageFile, ASerialPortIsADevice_AndAProfileAName) {
  EXPECT_THAT(refusal_of(page_with("hid", "path", "/etc/passwd")), HasSubstr("must be a device in /dev"));
  EXPECT_THAT(refusal_of(page_with("nmea", "device", "/dev/../etc/passwd")), HasSubstr("must be a device in /dev"));
  EXPECT_THAT(refusal_of(page_with("modbus", "profile", "/tmp/mine.toml")), HasSubstr("must be a name"));
  EXPECT_THAT(refusal_of(page_with("modbus", "profile", "mine.toml")), HasSubstr("must be a name"));
  EXPECT_EQ(refusal_of(page_with("nmea", "device", "/dev/serial/by-id/usb-FTDI")), "");
}

TEST(PageFile, TheDeviceOfAnotherSensorIsRefused) {
  const Config config = parse_config(kRoof, "a.toml");
  std::string same = kRoof;
  same.replace(same.find("roof"), 4, "mast");
  EXPECT_THAT(refusal_of(same, config), HasSubstr("sensors \"roof\" and \"mast\" both"));
}

TEST(PageFile, ASensorIsWrittenAndTakenOutAgain) {
  const PageSensor roof{.name = "\"roof\"\n[http]",
                        .driver = "nmea",
                        .values = {{"transport", "tcp"}, {"host", "::1"}, {"port", "4001"}, {"x]\n[http", "1"}}};
  EXPECT_THAT(refusal_of(with_sensor("", roof)), HasSubstr("page.toml"));
  PageSensor sound = roof;
  sound.name = "roof";
  sound.values.pop_back();
  const std::string one = with_sensor("", sound);
  sound.name = "mast \"2\"";
  sound.values.back().second = "4002";
  const std::string two = with_sensor(one, sound);
  EXPECT_EQ(refusal_of(two), "");
  EXPECT_THAT(*sensors_in(two), ElementsAre("roof", "mast \"2\""));
  const std::string rest = *without_sensor(two, "roof");
  EXPECT_THAT(names_in(with_page(default_config(), rest, "page.toml")), ElementsAre("mast \"2\""));
  EXPECT_THAT(*sensors_in(*without_sensor(rest, "mast \"2\"")), IsEmpty());
  EXPECT_FALSE(without_sensor(two, "nobody"));
  EXPECT_FALSE(without_sensor("[[", "roof"));
}

Config with_calibrated(const Config& config, const std::string& page) {
  return with_page(config, page, "page.toml");
}

TEST(PageFile, ACalibrationOfAMicrophoneIsOfItsLevel) {
  const std::string mic = "[[sensor]]\nname = \"mic\"\ndriver = \"microphone\"\n";
  const std::vector<ConfigChange> changes = {{"", "gain", 31.0}, {"", "exponent", 1.6}, {"calibration", "gain", 1.0}};
  const Config config = parse_config(mic + "[sensor.calibration]\ngain = 1.2\n", "a.toml");
  const std::string page = *with_calibration("", config, "mic", changes);
  const Config both = with_calibrated(config, page);
  EXPECT_EQ(both.sensors[0].values.number("gain"), 31.0);
  EXPECT_EQ(both.sensors[0].values.number("exponent"), 1.6);
  EXPECT_EQ(both.sensors[0].calibration.gain, 1.0);
  EXPECT_EQ(both.page_calibrations.at(0).values, "gain = 1.0, level_gain = 31.0, level_exponent = 1.6");
  const Config later =
      with_calibrated(parse_config(mic + "gain = 28\n[sensor.calibration]\ngain = 1.2\n", "a.toml"), page);
  EXPECT_EQ(later.sensors[0].values.number("gain"), 28.0) << "a later calibration of the file counts";
  EXPECT_THAT(later.page_calibrations.at(0).why_not, HasSubstr("was changed since"));

  // In the entry of a microphone that the page has set up.
  const std::string own = with_sensor("", {.name = "mic", .driver = "microphone", .values = {{"gain", "28"}}});
  const Config set_up = with_calibrated(default_config(), *with_calibration(own, default_config(), "mic", changes));
  EXPECT_EQ(set_up.sensors.back().values.number("gain"), 31.0);
  EXPECT_EQ(set_up.sensors.back().values.number("exponent"), 1.6);

  // A cup has no level, whatever is in a damaged file.
  const std::string cup = "[[sensor]]\nname = \"cup\"\ndriver = \"synthetic\"\n";
  std::string damaged = *with_calibration("", parse_config(cup, "a.toml"), "cup", {{{"calibration", "gain", 1.1}}});
  damaged.insert(damaged.find("sensor = "), "level_gain = 3.0\n");
  EXPECT_THROW(with_calibrated(parse_config(cup, "a.toml"), damaged), ConfigError);
  damaged = page;
  damaged.replace(damaged.find("microphone"), 10, "gone");
  EXPECT_THAT(with_calibrated(config, damaged).page_calibrations.at(0).why_not, HasSubstr("driver"));
}

TEST(PageFile, ACalibrationCountsUntilTheConfigurationHasAnother) {
  const std::string mast = "[[sensor]]\nname = \"mast\"\ndriver = \"synthetic\"\n";
  const Config config = parse_config(mast + "[sensor.calibration]\noffset = 0.1\nheight = 4\n", "a.toml");
  const std::vector<ConfigChange> changes = {{"calibration", "gain", 1.25}};
  const std::string page = *with_calibration("", config, "mast", changes);
  const Config both = with_calibrated(config, page);
  EXPECT_EQ(both.sensors[0].calibration.gain, 1.25);
  EXPECT_EQ(both.sensors[0].calibration.offset_m_s, 0.1);
  EXPECT_EQ(both.sensors[0].calibration.height_factor, config.sensors[0].calibration.height_factor);
  EXPECT_THAT(to_toml(both), HasSubstr("gain = 1.25"));
  ASSERT_EQ(both.page_calibrations.size(), 1U);
  EXPECT_EQ(both.page_calibrations[0].values, "gain = 1.25");
  EXPECT_EQ(both.page_calibrations[0].why_not, "");
  EXPECT_THAT(*calibrations_in(page), ElementsAre("mast"));

  const auto is_left_out = [&page](const std::string& changed, const char* why) {
    const Config later = with_calibrated(parse_config(changed, "a.toml"), page);
    EXPECT_EQ(later.sensors[0].calibration.gain, 1.0) << changed;
    EXPECT_THAT(later.page_calibrations.at(0).why_not, HasSubstr(why));
  };
  is_left_out(mast + "[sensor.calibration]\noffset = 0.2\n", "was changed since");
  is_left_out("[[sensor]]\nname = \"mast\"\ndriver = \"nmea\"\n[sensor.calibration]\noffset = 0.1\n", "was changed");
  is_left_out("[[sensor]]\nname = \"roof\"\ndriver = \"synthetic\"\n", "no such sensor");
  const Config later = parse_config(mast, "a.toml");
  const std::vector<ConfigChange> north = {{"calibration", "north_offset", 5.0}};
  const Config again = with_calibrated(later, *with_calibration(page, later, "mast", north));
  EXPECT_EQ(again.sensors[0].calibration.gain, 1.0) << "what does not count any more is gone";
  EXPECT_EQ(again.sensors[0].calibration.north_offset_deg, 5.0);
  EXPECT_THAT(*calibrations_in(*without_calibration(page, "mast")), IsEmpty());
  EXPECT_FALSE(without_calibration(page, "roof"));
  EXPECT_FALSE(with_calibration("", default_config(), "synthetic", changes)) << "it is in no file";
}

TEST(PageFile, ACalibrationSetsNothingElse) {
  const Config config = parse_config("[[sensor]]\nname = \"mast\"\ndriver = \"synthetic\"\n", "a.toml");
  const std::vector<ConfigChange> changes = {{"calibration", "gain", 1.25}};
  const std::string sound = *with_calibration("", config, "mast", changes);
  EXPECT_EQ(refusal_of(sound, config), "");
  for (const std::string hostile : {"height = 3.0\n", "command = \"true\"\n", "gain = 1000.0\n", "curve = \"5:3\"\n"}) {
    std::string page = sound;
    page.replace(page.find("gain = 1.25\n"), 12, hostile);
    EXPECT_THAT(refusal_of(page, config), HasSubstr("page.toml:")) << hostile;
  }
  EXPECT_NE(refusal_of("[calibration]\nsensor = \"mast\"\n", config), "");
  EXPECT_NE(refusal_of("[[calibration]]\nsensor = \"mast\"\ngain = 2.0\n", config), "") << "what does it replace?";
}

TEST(PageFile, ASensorOfThePageHasItsCalibrationWithIt) {
  const std::vector<ConfigChange> changes = {{"calibration", "gain", 1.25}};
  const std::string page = *with_calibration(kRoof, default_config(), "roof", changes);
  const Config both = with_page(default_config(), page, "page.toml");
  EXPECT_EQ(both.sensors[0].calibration.gain, 1.25);
  EXPECT_THAT(both.page_calibrations, IsEmpty());
}

constexpr const char* kMeadow = "[look]\nhaze = 0.2\n\n[[scene]]\nname = \"meadow\"\nkind = \"grass\"\ngain = 1.5\n";
constexpr const char* kKept = "[look]\nhaze = 0.7\n\n[[scene]]\nname = \"meadow\"\ngain = 2\nshown = false\n";

TEST(KeptValues, OverrideThoseOfTheConfiguration_AndNoOthers) {
  const Config config = parse_config(kMeadow, "a.toml");
  const Config both = with_page_values(config, kKept, "page.toml");
  EXPECT_EQ(both.look.haze, 0.7);
  EXPECT_EQ(both.look.clouds, config.look.clouds);
  EXPECT_EQ(both.by_name.at("look").number("haze"), 0.7);
  EXPECT_EQ(both.scenes[0].wind_gain, 2.0);
  EXPECT_FALSE(both.scenes[0].is_shown);
  EXPECT_THAT(both.kept, ElementsAre("[look] haze", "scene meadow: gain", "scene meadow: shown"));
  EXPECT_THAT(page_warnings(both), IsEmpty());
}

/// Of a scene that is gone, of a range that has changed, of a file that somebody has edited.
TEST(KeptValues, ThatCannotBeUsedArePassedOverWithTheirPlace_AndTheOthersAreUsed) {
  const Config config = parse_config(kMeadow, "a.toml");
  const auto passed_over = [&config](const std::string& page) {
    const Config both = with_page_values(config, page + "\n[[scene]]\nname = \"meadow\"\ngain = 2\n", "page.toml");
    EXPECT_EQ(both.scenes[0].wind_gain, 2.0) << page;
    return page_warnings(both);
  };
  const auto is = [](const std::string& why) {
    return ElementsAre(StartsWith("a value that the page keeps is passed over: page.toml:" + why));
  };
  EXPECT_THAT(passed_over("[[scene]]\nname = \"elm\"\ngain = 2\n"), is("3:8: scene: there is no scene \"elm\""));
  EXPECT_THAT(passed_over("[look]\nhaze = 7\n"), is("2:8: look.haze: is 7"));
  EXPECT_THAT(passed_over("[look]\nhaze = \"much\"\n"), is("2:8: look.haze: is a text"));
  EXPECT_THAT(passed_over("[look]\nhaze = [1]\n"), is("2:8: haze: takes one value"));
  EXPECT_THAT(passed_over("[look]\nunknown = 1\n"), is("2:11: look.unknown: "));
  EXPECT_THAT(passed_over("[look]\nground_image = \"/etc/passwd\"\n"),
              is("2:16: look.ground_image: is read only from"));
  EXPECT_THAT(passed_over("look = 1\n"), is("1:8: look: is a value"));
  EXPECT_THAT(passed_over("[[scene]]\ngain = 2\n"), is("1:1: scene.name: is missing"));
  EXPECT_THAT(passed_over("[[scene]]\nname = \"meadow\"\nkind = \"tree\"\n"), is("3:8: scene.kind: "));
}
/// No path and no command: each key that may be kept is one that may be set while the daemon runs.
TEST(KeptValues, AreThoseAloneThatCanBeSetWhileTheDaemonRuns) {
  for (const std::string_view kind : {"flag", "curtain", "banner"}) {
    const Config config = parse_config(fmt::format("[[scene]]\nname = \"a\"\nkind = \"{}\"\n", kind), "a.toml");
    const Config both = with_page_values(config, "[[scene]]\nname = \"a\"\nimage = \"/etc/passwd\"\n", "page.toml");
    EXPECT_THAT(both.kept, IsEmpty());
    EXPECT_THAT(both.passed_over, ElementsAre(HasSubstr("scene.image: is read only from the configuration")));
  }
}
TEST(KeptValues, AreWrittenBesideTheSensors_AndTakenOut) {
  const Config config = parse_config(kMeadow, "a.toml");
  const std::vector<ParameterEdit> values{{"", "haze", "0.6"}, {"meadow", "gain", "3"}};
  const auto next = edited(config, config, values);
  ASSERT_TRUE(next);
  const std::string gone = std::string(kRoof) + "[[scene]]\nname = \"elm\"\ngain = 4\n" + kKept;
  const auto written = with_values(gone, values, *next);
  ASSERT_TRUE(written);
  const Config both = with_page_values(config, *written, "page.toml");
  EXPECT_EQ(both.look.haze, 0.6);
  EXPECT_EQ(both.scenes[0].wind_gain, 3.0);
  EXPECT_THAT(both.kept, ElementsAre("[look] haze", "scene meadow: gain", "scene meadow: shown"));
  EXPECT_THAT(both.passed_over, ElementsAre(HasSubstr("\"elm\""))) << "nothing is lost";
  EXPECT_THAT(kept_in(*written).value(),
              ElementsAre("[look] haze", "scene elm: gain", "scene meadow: gain", "scene meadow: shown"));
  EXPECT_THAT(names_in(with_page(default_config(), *written, "page.toml")), ElementsAre("roof"));
  EXPECT_TRUE(have_same_sensors(*written, kRoof));
  EXPECT_FALSE(have_same_sensors(*written, ""));
  EXPECT_FALSE(have_same_sensors("[[", "[["));

  const auto without = without_values(*written);
  ASSERT_TRUE(without);
  EXPECT_THAT(kept_in(*without).value(), IsEmpty());
  EXPECT_TRUE(have_same_sensors(*without, kRoof));
  EXPECT_FALSE(with_values("[[", values, *next));
  EXPECT_FALSE(without_values("[["));
  EXPECT_FALSE(kept_in("[["));
}
TEST(KeptValues, AreNamedInWhatAReloadReports) {
  const Config config = parse_config(kMeadow, "a.toml");
  const ReloadPlan plan = plan_reload(config, with_page_values(config, kKept, "page.toml"), true);
  EXPECT_THAT(plan.applied, ElementsAre("[look] haze: 0.2 -> 0.7 (kept on the page)",
                                        "scene meadow: gain: 1.5 -> 2.0 (kept on the page)",
                                        "scene meadow: shown: true -> false (kept on the page)"));
  EXPECT_THAT(plan.next.kept, testing::SizeIs(3));
}

class PageFileOfAnInstallation : public testing::Test {
 protected:
  PageFileOfAnInstallation() {
    unsetenv("STATE_DIRECTORY");  // NOLINT(concurrency-mt-unsafe): one thread
    write(config_,
          "[[sensor]]\nname = \"mast\"\ndriver = \"nmea\"\ntransport = \"tcp\"\nhost = \"::1\"\nport = 4002\n");
  }

  static void write(const std::filesystem::path& file, std::string_view text) {
    std::ofstream(file, std::ios::binary) << text;
  }

  test::TemporaryFolder folder_;
  std::filesystem::path config_ = folder_ / "a.toml";
  std::filesystem::path page_ = folder_ / "a.toml.page.toml";
};

TEST_F(PageFileOfAnInstallation, IsReadAfterTheConfiguration) {
  EXPECT_THAT(names_in(load_installation(config_)), ElementsAre("mast"));
  write(page_, kRoof);
  const Config both = load_installation(config_);
  EXPECT_THAT(names_in(both), ElementsAre("mast", "roof"));
  EXPECT_EQ(both.page_trouble, "");
  EXPECT_EQ(both.page_file, page_.string());
  EXPECT_THAT(both.sensors.back().origin, StartsWith(page_.string() + ":1:1"));
}

TEST_F(PageFileOfAnInstallation, ItsValuesAreUsedAlsoIfItsSensorsCannotBe) {
  write(page_, "[look]\nhaze = 0.7\n[[sensor]]\nname = \"mast\"\ndriver = \"synthetic\"\n");
  const Config config = load_installation(config_);
  EXPECT_EQ(config.look.haze, 0.7);
  EXPECT_THAT(names_in(config), ElementsAre("mast"));
  EXPECT_THAT(page_warnings(config), ElementsAre(HasSubstr("\"mast\" is in use")));
}

/// The configuration alone runs.
TEST_F(PageFileOfAnInstallation, IsLeftOutIfItIsDamaged_AndThatIsSaid) {
  const auto is_left_out = [this](std::string_view text) {
    write(page_, text);
    const Config config = load_installation(config_);
    EXPECT_THAT(names_in(config), ElementsAre("mast"));
    EXPECT_THAT(config.page_trouble, HasSubstr("a.toml.page.toml:")) << text.substr(0, 80);
    EXPECT_THAT(plan_reload(load_config(config_), config, true).applied, ElementsAre("the page's file is left out"));
  };
  is_left_out("[[sensor");
  is_left_out(std::string_view("\0\xff\xfe", 3));
  is_left_out(std::string(kMaxPage_bytes + 1, '#'));
  is_left_out("[[sensor]]\nname = \"mast\"\ndriver = \"synthetic\"\n");
  is_left_out("[[sensor]]\nname = \"same\"\ndriver = \"nmea\"\ntransport = \"tcp\"\nhost = \"::1\"\nport = 4002\n");
  is_left_out("[[sensor]]\ndriver = \"line\"\ntransport = \"file\"\nfile = \"/etc/passwd\"\n");
  std::filesystem::remove(page_);
  std::filesystem::create_directory(page_);
  EXPECT_THAT(load_installation(config_).page_trouble, HasSubstr("a.toml.page.toml:1:1: file:"));
}

/// It stands in a file of its owner alone.
TEST_F(PageFileOfAnInstallation, APasswordInItDoesNotMakeTheConfigurationASecret) {
  write(page_, "[[sensor]]\ndriver = \"mqtt\"\ntopic = \"wind\"\npassword = \"correct horse\"\n");
  const Config config = load_installation(config_);
  ASSERT_EQ(config.page_trouble, "");
  EXPECT_THAT(exposed_secrets(config, config_), IsEmpty());
}

TEST_F(PageFileOfAnInstallation, AMistakeOfTheConfigurationIsNotItsFault) {
  write(page_, kRoof);
  write(config_, "[[sensor]]\ndriver = \"nmea\"\nport = 0\n");
  EXPECT_THROW(load_installation(config_), ConfigError);
}

TEST_F(PageFileOfAnInstallation, OfTheServiceIsInTheFolderOfItsUnit) {
  EXPECT_EQ(page_file("/etc/yuragi/yuragi.toml"), "/var/lib/yuragi/page.toml");
  EXPECT_EQ(page_file(config_), page_);
  EXPECT_EQ(page_file(""), "");
}

}  // namespace
}  // namespace yuragi::daemon::settings
