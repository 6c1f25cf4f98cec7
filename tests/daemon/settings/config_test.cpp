#include "daemon/settings/config.hpp"

#include <array>
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "daemon/settings/config_edit.hpp"
#include "daemon/settings/recorded_sensor.hpp"
#include "daemon/settings/secret_exposure.hpp"
#include "daemon/settings/sensor_blend.hpp"
#include "daemon/settings/site_octaves.hpp"
#include "engine/wind/turbulence/site_spectrum.hpp"
#include "tests/support/small_png.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::daemon::settings {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::MatchesRegex;
using ::testing::Not;
using ::testing::StartsWith;
using ::testing::ThrowsMessage;

/// What the reader says of a wrong text.
std::string mistakes_of(std::string_view text) {
  try {
    parse_config(text, "wall.toml");
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no mistake was found";
}

TEST(Config, ChecksTheOutputsOfTheViewersAndWritesThemOut) {
  const std::string text =
      "[[output]]\nname = \"foyer\"\n[[output.window]]\nmonitor = \"HDMI-1\"\ncrop = \"0 0 0.5 1\"\n";
  const Config config = parse_config(text, "wall.toml");
  ASSERT_EQ(config.outputs.size(), 1U);
  EXPECT_EQ(config.outputs[0].output.windows.at(0).monitor, "HDMI-1");
  const Config again = parse_config(to_toml(config), "written.toml");
  ASSERT_EQ(again.outputs.size(), 1U);
  EXPECT_EQ(again.outputs[0].output, config.outputs[0].output);
  EXPECT_THAT(mistakes_of("[[output]]\n[[output.window]]\ncrop = \"1 1 1 1\"\n"),
              StartsWith("wall.toml:3:8: output.window.crop: is \"1 1 1 1\""));
}

TEST(Config, HasTheColorsAndThePictureOfACloth) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "wall.toml";
  const auto write = [](const std::filesystem::path& to, std::string_view bytes) {
    std::ofstream(to, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  };
  const std::vector<std::uint8_t> png = test::small_png();
  write(folder.path() / "crest.png", {reinterpret_cast<const char*>(png.data()), png.size()});
  write(file, "[[scene]]\nkind = \"flag\"\ncolor = \"#1b2A49\"\nimage = \"crest.png\"\n");

  const look::ClothLook flag = load_config(file).scenes.at(0).cloth;
  EXPECT_EQ(flag.color, (look::Color{0x1b, 0x2a, 0x49}));
  EXPECT_EQ(flag.color_2, std::nullopt);
  ASSERT_NE(flag.image, nullptr);
  EXPECT_EQ(flag.image->width_px, 2U);
  EXPECT_EQ(parse_config(read_config_text(file), file.string()).scenes.at(0).cloth.image, nullptr)
      << "a recorded configuration may be without its pictures";

  write(folder.path() / "text.png", "no picture");
  write(file,
        "[[scene]]\nkind = \"curtain\"\nimage = \"gone.png\"\n[[scene]]\nkind = \"banner\"\nimage = \"text.png\"\n"
        "color_2 = \"#12345\"\n[[scene]]\nkind = \"flag\"\ncolor = \"red\"\n");
  EXPECT_THAT([&] { load_config(file); },
              ThrowsMessage<ConfigError>(AllOf(
                  HasSubstr("wall.toml:3:9: scene.image: \"gone.png\" cannot be read: No such file or directory; give"),
                  HasSubstr("wall.toml:6:9: scene.image: \"text.png\" is neither a PNG nor a JPEG file; save it as"),
                  HasSubstr("wall.toml:7:11: scene.color_2: is \"#12345\"; allowed: \"#rrggbb\""),
                  HasSubstr("wall.toml:10:9: scene.color: is \"red\"; allowed"))));
  EXPECT_THAT(mistakes_of("[[scene]]\nkind = \"grass\"\ncolor = \"#112233\"\n"),
              HasSubstr("color: is not a known key"));
}

TEST(Config, RefusesNamesWithControlCharactersAtTheirPlace) {
  for (const std::string entry :
       {"[[sensor]]\ndriver = \"synthetic\"\n", "[[scene]]\nkind = \"grass\"\n", "[[camera]]\nfrom = \"06:00\"\n",
        "[[alert]]\ncommand = \"true\"\n", "[[output]]\nrefreshes = 2\n"}) {
    for (const std::string hurt : {"\\u001b[2J", "\\n", "\\u007f", "\\u0085", "\\u202E", "\\u2066"}) {
      EXPECT_THAT(
          mistakes_of(fmt::format("{}name = \"a{}\"\n", entry, hurt)),
          MatchesRegex("wall.toml:3:8: [a-z]+.name: \"a\\?+(\\[2J)?\" has a control character in it; type it anew"))
          << entry << hurt;
    }
    EXPECT_THAT(mistakes_of(entry + "name = \"M\u00fcller \u98a8\"\n"), Not(HasSubstr("control"))) << entry;
  }
}

TEST(Config, RefusesTextsAndShowsKeysWithControlCharacters) {
  EXPECT_EQ(
      mistakes_of("[[output]]\n[[output.window]]\nmonitor = \"HDMI\\u001b\"\n"),
      "wall.toml:3:11: output.window.monitor: has a control character in it; allowed: text; left out: the primary "
      "one");
  EXPECT_THAT(mistakes_of("\"a\\u001bb\" = 1\n"), HasSubstr("wall.toml:1:1: a?b: is not known here"));
  const Config config = parse_config(
      "[[sensor]]\ndriver = \"line\"\nspeed_unit = \"m/s\"\nrequest = \"?\\r\\n\"\n"
      "[[alert]]\nname = \"storm\"\nwhen = \"wind_above\"\ncommand = \"\"\"\necho a\necho b\"\"\"\n",
      "wall.toml");
  EXPECT_EQ(config.sensors.at(0).values.text("request"), "?\r\n") << "bytes for a device";
  EXPECT_EQ(config.alerts.at(0).command, "echo a\necho b") << "a script";
}

TEST(Config, RefusesAKeyOfThousandsOfParts) {
  std::string key = "a";
  for (int i = 0; i < 50'000; ++i) key += ".a";
  EXPECT_THAT(mistakes_of(key + " = 1\n"), StartsWith("wall.toml:1:1: TOML: nested too deeply"));
  EXPECT_THAT(mistakes_of("[[sensor]]\ndriver = \"synthetic\"\n" + key + " = 1\n"),
              StartsWith("wall.toml:3:1: TOML: nested too deeply"));
}

TEST(Config, HasThePictureOfTheGround) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "wall.toml";
  const auto write = [](const std::filesystem::path& to, std::string_view bytes) {
    std::ofstream(to, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  };
  const std::vector<std::uint8_t> png = test::small_png();
  write(folder.path() / "mats.png", {reinterpret_cast<const char*>(png.data()), png.size()});
  write(file, "[look]\nground_image = \"mats.png\"\nground_image_width = 1.8\n");

  const Config config = load_config(file);
  EXPECT_EQ(config.look.ground_image_width_m, 1.8);
  const auto ground = std::ranges::find(config.scenes, "ground", &SceneConfig::name);
  ASSERT_NE(ground, config.scenes.end());
  ASSERT_NE(ground->cloth.image, nullptr);
  EXPECT_EQ(ground->cloth.image->width_px, 2U);
  EXPECT_EQ(config.scenes.at(0).cloth.image, nullptr) << "of the grass";

  write(file, "[look]\nground_image = \"gone.png\"\n");
  EXPECT_THAT([&] { load_config(file); },
              ThrowsMessage<ConfigError>(
                  HasSubstr("wall.toml:2:16: look.ground_image: \"gone.png\" cannot be read: No such file")));
  // A PNG that says it has 65,536 x 65,536 pixels is refused before there is memory for them.
  std::vector<std::uint8_t> huge = png;
  huge[16] = huge[20] = 0;
  huge[17] = huge[21] = 1;
  write(folder.path() / "huge.png", {reinterpret_cast<const char*>(huge.data()), huge.size()});
  write(file, "[look]\nground_image = \"huge.png\"\n");
  EXPECT_THAT([&] { load_config(file); },
              ThrowsMessage<ConfigError>(HasSubstr("wall.toml:2:16: look.ground_image: \"huge.png\" ")));
  EXPECT_THAT(mistakes_of("[look]\nground_image = \"mats.png\"\n[[scene]]\nkind = \"grass\"\n"),
              HasSubstr("look.ground_image: needs a scene that is missing; add [[scene]] with kind = \"ground\""));
}

TEST(Config, HasTheLookWithTheLineOfAMistake) {
  EXPECT_EQ(parse_config("[look]\nlatitude = 52.5\n", "wall.toml").look.sun, look::SunChoice::kTime);
  try {
    parse_config("[look]\nclouds = 0.5\ntime = \"noon\"\n", "wall.toml");
    FAIL() << "noon is no time of the day";
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(),
                 "wall.toml:3:8: look.time: is \"noon\"; allowed: \"now\", or a time of the day such as \"06:30\"");
  }
}

TEST(Config, HasCameras) {
  const Config config = parse_config(
      "[shaping]\nzone = \"Asia/Tokyo\"\n"
      "[[scene]]\nkind = \"flag\"\nname = \"pole\"\n"
      "[[camera]]\nname = \"near\"\nscene = \"pole\"\nsway = 5\n"
      "[[camera]]\nname = \"night\"\ntarget_y = 2\ndistance = 30\nfrom = \"21:30\"\n",
      "wall.toml");
  ASSERT_EQ(config.cameras.size(), 2U);
  EXPECT_EQ(config.cameras[0].camera, (look::Camera{.name = "near", .scene = "pole", .sway_deg = 5.0}));
  EXPECT_EQ(config.cameras[1].camera,
            (look::Camera{.name = "night", .target_y_m = 2.0, .distance_m = 30.0, .from_h = 21.5}));
  EXPECT_EQ(config.clock.zone_name(), "Asia/Tokyo");

  // What is printed and recorded says the same.
  const Config again = parse_config(to_toml(config), "again.toml");
  ASSERT_EQ(again.cameras.size(), 2U);
  EXPECT_EQ(again.cameras[0].camera, config.cameras[0].camera);
  EXPECT_EQ(again.cameras[1].camera, config.cameras[1].camera);
}

TEST(Config, ACameraMayLookAtASceneThatIsThereByDefault) {
  EXPECT_EQ(parse_config("[[camera]]\nname = \"a\"\nscene = \"grass\"\n", "wall.toml").cameras.size(), 1U);
}

TEST(Config, TellsEachMistakeOfACameraWithItsPlace) {
  EXPECT_EQ(mistakes_of("[camera]\nname = \"a\"\n"),
            "wall.toml:1:2: camera: is a single table; write its heading as [[camera]]");
  EXPECT_EQ(mistakes_of("[[camera]]\nheading = 10\n"),
            "wall.toml:1:1: camera.name: is missing; give each camera a name");
  EXPECT_EQ(mistakes_of("[[camera]]\nname = \"a\"\n[[camera]]\nname = \"a\"\n"),
            "wall.toml:4:8: camera.name: \"a\" is used twice; give each camera a different name");
  EXPECT_EQ(mistakes_of("[[camera]]\nname = \"a\"\nfrom = \"dusk\"\n"),
            "wall.toml:3:8: camera.from: is \"dusk\"; allowed: a time of the day such as \"06:30\"");
  EXPECT_EQ(mistakes_of("[[camera]]\nname = \"a\"\nfrom = \"06:30\"\n[[camera]]\nname = \"b\"\nfrom = \"06:30\"\n"),
            "wall.toml:6:8: camera.from: is also the start of the camera \"a\"; give each camera a different time");
  EXPECT_EQ(mistakes_of("[[camera]]\nname = \"a\"\nscene = \"tree\"\n[[scene]]\nkind = \"flag\"\nname = \"pole\"\n"),
            "wall.toml:3:9: camera.scene: is \"tree\"; allowed: the name of a scene: \"pole\"");
  EXPECT_THAT(mistakes_of("[[camera]]\nname = \"a\"\nfov = 180\n"), StartsWith("wall.toml:3:7: camera.fov: "));
  std::string many;
  for (std::size_t i = 0; i <= look::kMaxCameras; ++i) many += "[[camera]]\nname = \"" + std::to_string(i) + "\"\n";
  EXPECT_EQ(mistakes_of(many), "wall.toml:65:1: camera: too many: 33 (maximum 32)");
}

TEST(Config, HasAlerts) {
  const Config config = parse_config(
      "[[sensor]]\nname = \"roof\"\ndriver = \"synthetic\"\n"
      "[[alert]]\nname = \"dead\"\nsensor = \"roof\"\ncommand = \"page\"\n"
      "[[alert]]\nname = \"storm\"\nwhen = \"wind_above\"\nspeed = 20\nend_after = 600\n"
      "webhook = \"https://chat.example/hooks/s3cret\"\n"
      "[[alert]]\nname = \"disk\"\nwhen = \"disk_below\"\nfree = 500\nafter = 5\ncommand = \"page\"\n",
      "wall.toml");
  ASSERT_EQ(config.alerts.size(), 3U);
  EXPECT_EQ(config.alerts[0].sensor, "roof");
  EXPECT_EQ(config.alerts[0].after_s, 60.0);
  EXPECT_EQ(config.alerts[1].when, AlertCondition::kWindAbove);
  EXPECT_EQ(config.alerts[1].speed_m_s, 20.0);
  EXPECT_EQ(config.alerts[1].after_s, 0.0) << "a gust is enough";
  EXPECT_EQ(config.alerts[1].end_after_s, 600.0);
  EXPECT_EQ(config.alerts[1].webhook, Secret("https://chat.example/hooks/s3cret"));
  EXPECT_EQ(config.alerts[2].free_bytes, 500e6);
  EXPECT_EQ(config.alerts[2].after_s, 5.0);

  // What is printed and recorded says the same, except for secrets; a command may hold one.
  const std::string printed = to_toml(config);
  EXPECT_THAT(printed, Not(HasSubstr("s3cret")));
  const Config again = parse_config(printed, "again.toml");
  ASSERT_EQ(again.alerts.size(), 3U);
  EXPECT_EQ(again.alerts[0].command, "");
  EXPECT_THAT(printed, Not(HasSubstr("page")));
  EXPECT_TRUE(again.alerts[1].webhook.is_empty());
}

TEST(Config, TellsEachMistakeOfAnAlertWithItsPlace) {
  EXPECT_EQ(mistakes_of("[alert]\nname = \"a\"\n"),
            "wall.toml:1:2: alert: is a single table; write its heading as [[alert]]");
  EXPECT_EQ(mistakes_of("[[alert]]\ncommand = \"page\"\n"),
            "wall.toml:1:1: alert.name: is missing; give each alert a name");
  EXPECT_EQ(mistakes_of("[[alert]]\nname = \"a\"\ncommand = \"x\"\n[[alert]]\nname = \"a\"\ncommand = \"x\"\n"),
            "wall.toml:5:8: alert.name: \"a\" is used twice; give each alert a different name");
  EXPECT_EQ(mistakes_of("[[alert]]\nname = \"a\"\n"),
            "wall.toml:1:1: alert.command: is missing, and webhook too, so nobody would be notified; set one of them");
  EXPECT_EQ(mistakes_of("[[alert]]\nname = \"a\"\ncommand = \"x\"\nsensor = \"rof\"\n"),
            "wall.toml:4:10: alert.sensor: is \"rof\"; allowed: the name of a [[sensor]] of this file");
  EXPECT_EQ(mistakes_of("[[alert]]\nname = \"a\"\ncommand = \"x\"\nwhen = \"no_frame\"\nsensor = \"roof\"\n"),
            "wall.toml:5:10: alert.sensor: applies only if when = \"sensor_silent\"; remove it");
  EXPECT_EQ(mistakes_of("[[alert]]\nname = \"a\"\nwebhook = \"ftp://there/\"\n"),
            "wall.toml:3:11: alert.webhook: must be a URL that begins with http:// or https://");
  EXPECT_THAT(mistakes_of("[[alert]]\nname = \"a\"\ncommand = \"x\"\nwhen = \"late\"\n"),
              StartsWith("wall.toml:4:8: alert.when: "));
  std::string many;
  for (std::size_t i = 0; i <= kMaxAlerts; ++i)
    many += "[[alert]]\ncommand = \"x\"\nname = \"" + std::to_string(i) + "\"\n";
  EXPECT_EQ(mistakes_of(many), "wall.toml:193:1: alert: too many: 65 (maximum 64)");
}

TEST(Config, AnEmptyFileIsTheDefaultInstallation) {
  const Config config = parse_config("", "empty.toml");
  ASSERT_EQ(config.sensors.size(), 1U);
  EXPECT_EQ(config.sensors[0].driver->name, "synthetic");
  ASSERT_EQ(config.scenes.size(), 2U);
  EXPECT_EQ(config.scenes[0].kind->name, "grass");
  EXPECT_EQ(config.scenes[1].kind->name, "ground");
  EXPECT_EQ(config.stream.listen, "127.0.0.1:7410");
  EXPECT_EQ(config.animation.rate_hz, 60.0);
}

TEST(Config, TakesWhatTheFileSaysAndDefaultsForTheRest) {
  const Config config = parse_config(R"(
seed = 12
[wind]
default_speed = 7
[[sensor]]
driver = "synthetic"
name = "attic"
speed = 9.5
[[scene]]
kind = "grass"
name = "meadow"
)",
                                     "wall.toml");
  EXPECT_EQ(config.seed, 12U);
  EXPECT_EQ(config.wind.default_speed_m_s, 7.0) << "a whole number passes for a number";
  EXPECT_EQ(config.wind.default_direction_deg, 240.0);
  EXPECT_EQ(config.sensors[0].name, "attic");
  EXPECT_EQ(config.sensors[0].values.number("speed"), 9.5);
  EXPECT_EQ(config.sensors[0].origin, "wall.toml:5:1");
  EXPECT_EQ(config.scenes[0].name, "meadow");
}

TEST(Config, AParameterThatASceneHadOnceIsToldWithWhatItIsNow) {
  EXPECT_THAT(mistakes_of("[[scene]]\nkind = \"fur\"\nturbulence = 0.5\n"),
              StartsWith("wall.toml:3:14: scene.turbulence: is now strokes"));
}

TEST(Config, EveryMistakeIsToldAtItsPlaceWithWhatIsAllowed) {
  EXPECT_THAT(mistakes_of("[animation]\nrate = 1000\n"),
              StartsWith("wall.toml:2:8: animation.rate: is 1000; allowed: number from 1 to 240 Hz"));
  EXPECT_THAT(mistakes_of("seed = \"seven\"\n"),
              StartsWith("wall.toml:1:8: seed: is a text (\"seven\"); allowed: whole number"));
  EXPECT_THAT(mistakes_of("[wind]\ngusts = 3\n"),
              StartsWith("wall.toml:2:9: wind.gusts: is not a known key here; known: default_speed"));
  EXPECT_THAT(mistakes_of("[win]\nx = 1\n"),
              StartsWith("wall.toml:1:2: win: is not known here; allowed: seed, [stream]"));
  EXPECT_THAT(mistakes_of("wind = 3\n"), StartsWith("wall.toml:1:1: wind: is a value; write it as a table"));
  EXPECT_THAT(mistakes_of("[sensor]\ndriver = \"synthetic\"\n"),
              StartsWith("wall.toml:1:2: sensor: is a single table; write its heading as [[sensor]]"));
  EXPECT_THAT(mistakes_of("[[sensor]]\nspeed = 3\n"),
              testing::AllOf(HasSubstr("sensor.driver: is missing or not a text; allowed: one of "),
                             HasSubstr("\"synthetic\"")));
  std::string many;
  for (int i = 0; i < 256; ++i) many += "[[sensor]]\ndriver = \"synthetic\"\nname = \"" + std::to_string(i) + "\"\n";
  EXPECT_THAT(mistakes_of(many), testing::StrEq("wall.toml:766:1: sensor: too many: 256 (maximum 255)"));
  EXPECT_THAT(mistakes_of("[[sensor]]\ndriver = \"barometer\"\n"),
              StartsWith("wall.toml:2:10: sensor.driver: is \"barometer\"; allowed: one of"));
  EXPECT_THAT(mistakes_of("[[scene]]\nkind = \"grass\"\nlinks = [1, 2]\n"),
              StartsWith("wall.toml:3:9: scene.links: takes one value"));
  EXPECT_THAT(mistakes_of("[wind]\ndefault_speed = nan\n"),
              StartsWith("wall.toml:2:17: wind.default_speed: is nan; allowed: number from 0 to 40 m/s"));
  EXPECT_THAT(mistakes_of("[[sensor]]\ndriver=\"synthetic\"\n[[sensor]]\ndriver=\"synthetic\"\n"),
              HasSubstr("\"synthetic\" is used twice"));
}

TEST(Config, ASensorOfAnyDriverHasACalibration) {
  const Config config = parse_config(R"(
[[sensor]]
driver = "synthetic"
[sensor.calibration]
gain = 1.05
curve = "0:0 5:5.5"
height = 2
[[sensor]]
driver = "synthetic"
name = "other"
)",
                                     "wall.toml");
  const wind::judging::Calibration& calibration = config.sensors[0].calibration;
  EXPECT_EQ(calibration.gain, 1.05);
  EXPECT_EQ(calibration.curve.size(), 2U);
  EXPECT_EQ(calibration.height_factor, wind::judging::height_factor(2.0, 10.0, 0.03));
  EXPECT_EQ(config.sensors[0].heights.sensor_m, 2.0);
  EXPECT_EQ(config.sensors[0].heights.scene_m, 10.0);
  EXPECT_FALSE(config.sensors[1].heights.sensor_m.has_value());
  EXPECT_EQ(config.sensors[1].calibration.gain, 1.0);
  EXPECT_EQ(config.sensors[1].calibration.height_factor, 1.0);
  EXPECT_EQ(to_toml(parse_config(to_toml(config), "again.toml")), to_toml(config));

  const std::string sensor = "[[sensor]]\ndriver = \"synthetic\"\n";
  const Config in_km_h = parse_config(sensor + "[sensor.calibration]\nunit = \"km/h\"\n", "wall.toml");
  EXPECT_EQ(in_km_h.sensors[0].calibration.unit_m_s, 1.0 / 3.6);
  EXPECT_THAT(mistakes_of(sensor + "[sensor.calibration]\nunit = \"km\"\n"), HasSubstr("sensor.calibration.unit: is"));
  EXPECT_THAT(mistakes_of(sensor + "[sensor.calibration]\ngain = 0\n"),
              StartsWith("wall.toml:4:8: sensor.calibration.gain: is 0; allowed: number from 0.01 to 100"));
  EXPECT_THAT(mistakes_of(sensor + "[sensor.calibration]\ncurve = \"5\"\n"),
              StartsWith("wall.toml:4:9: sensor.calibration.curve: \"5\" is not a curve; allowed:"));
  EXPECT_THAT(mistakes_of(sensor + "calibration = 3\n"),
              StartsWith("wall.toml:3:15: sensor.calibration: is a value; write it as a table"));
  EXPECT_THAT(mistakes_of("[[scene]]\nkind = \"grass\"\n[scene.calibration]\ngain = 2\n"),
              HasSubstr("scene.calibration: takes one value"));
}

TEST(Config, GustsReachAsFarAsTheHeightOfASensorSaysUnlessTheirLengthIsSet) {
  const std::string sensors =
      "[[sensor]]\nname = \"low\"\ndriver = \"synthetic\"\n[sensor.calibration]\nheight = 4.4\nscene_height = 4.4\n"
      "[[sensor]]\nname = \"mast\"\ndriver = \"synthetic\"\n[sensor.calibration]\nheight = 15\nscene_height = 15\n"
      "[[sensor]]\nname = \"raised\"\ndriver = \"synthetic\"\n[sensor.calibration]\nheight = 4.4\n"
      "[[sensor]]\nname = \"any\"\ndriver = \"synthetic\"\n";
  const Config derived = parse_config(sensors, "test");
  ASSERT_EQ(derived.sensors.size(), 4U);
  EXPECT_NEAR(gust_length_m(derived.wind, derived.sensors[0]), 25.0, 0.1);
  EXPECT_NEAR(gust_length_m(derived.wind, derived.sensors[1]), 85.0, 0.1);
  // Brought to 10 m, speed and length by the same factor: it passes in the same time.
  EXPECT_NEAR(gust_length_m(derived.wind, derived.sensors[2]), 24.95 * wind::judging::height_factor(4.4, 10.0, 0.03),
              0.1);
  EXPECT_EQ(gust_length_m(derived.wind, derived.sensors[3]), 57.0);
  EXPECT_EQ(derived.wind.gust_length_m(), 57.0);

  const Config set = parse_config("[wind]\ndefault_length = 40\n" + sensors, "test");
  for (const SensorConfig& sensor : set.sensors) EXPECT_EQ(gust_length_m(set.wind, sensor), 40.0) << sensor.name;
  EXPECT_EQ(set.wind.gust_length_m(), 40.0);
}

TEST(Config, TheOctavesOfASiteAreARowOfDecibels) {
  const Config config = parse_config("[wind]\nsite_octaves = \"+1.2 -0.4 3\"\n", "test");
  EXPECT_EQ(config.wind.site_octaves_db, (std::vector{1.2, -0.4, 3.0}));
  wind::turbulence::SiteSpectrum site;
  site.expect(config.wind.site_octaves_db);
  const wind::turbulence::SiteSpectrum::Decibels octaves_db = site.octaves_db();
  EXPECT_NEAR(octaves_db[0], 1.2, 1e-9);
  EXPECT_NEAR(octaves_db[1], -0.4, 1e-9);
  EXPECT_NEAR(octaves_db[2], 3.0, 1e-9);
  EXPECT_NEAR(octaves_db[6], 3.0, 1e-9);
  EXPECT_EQ(site_octaves_text(std::vector<double>{1.2, -0.4, 3.0}), "+1.2 -0.4 +3.0");
  EXPECT_TRUE(parse_site_octaves(" ")->empty());
  for (const char* wrong : {"1.2 x", "11", "nan", "+-1", "1 2 3 4 5 6 7 8", "1,2"}) {
    EXPECT_THAT(mistakes_of("[wind]\nsite_octaves = \"" + std::string(wrong) + "\"\n"),
                StartsWith("wall.toml:2:16: wind.site_octaves: "))
        << wrong;
  }
}

TEST(Config, WhatDoesNotFitTogetherInTheShapingIsToldAtItsPlace) {
  EXPECT_THAT(mistakes_of("[shaping]\nhours = \"25:00-18:00\"\n"),
              StartsWith("wall.toml:2:9: shaping.hours: has \"25:00-18:00\"; allowed: FROM-TO"));
  EXPECT_THAT(mistakes_of("[shaping]\nfloor = 1\nzone = \"Mars\"\n"),
              StartsWith("wall.toml:3:8: shaping.zone: is \"Mars\", a time zone that this machine does not know"));
  EXPECT_THAT(mistakes_of("[shaping]\nceiling_most = 12\n"),
              StartsWith("wall.toml:2:16: shaping.ceiling_most: is 12; allowed: more than ceiling, which is 17"));
  EXPECT_THAT(mistakes_of("[shaping]\nceiling = 30\n"), StartsWith("wall.toml:1:1: shaping.ceiling_most: is 25"));
  EXPECT_THAT(mistakes_of("[shaping]\nsite_median = 3\nsite_strong = 3\n"),
              StartsWith("wall.toml:3:15: shaping.site_strong: is 3, with site_median 3"));
  EXPECT_THAT(mistakes_of("[shaping]\nfloor = -1\n"), StartsWith("wall.toml:2:9: shaping.floor: is -1"));
  EXPECT_THAT(mistakes_of("shaping = 3\n"), StartsWith("wall.toml:1:1: shaping: is a value; write it as a table"));
  const Config config =
      parse_config("[shaping]\nceiling = 0\nceiling_most = 1\nhours = \"10:00-18:00\"\n", "wall.toml");
  EXPECT_EQ(config.shaping.settings.ceiling.gain(60.0), 1.0) << "nothing is held back";
  EXPECT_FALSE(config.shaping.hours.is_always_open());
  EXPECT_EQ(to_toml(parse_config(to_toml(config), "again.toml")), to_toml(config));
}

TEST(Config, ASensorThatSpeaksOnChangeIsUnchangedWhileItIsSilent) {
  const std::string sensor = "[[sensor]]\ndriver = \"mqtt\"\ntopic = \"wind\"\nsilence = 43200\n";
  EXPECT_EQ(parse_config(sensor, "wall.toml").sensors[0].blend.unchanged_for_s, 0.0);
  const Config config = parse_config(sensor + "on_change = true\n", "wall.toml");
  EXPECT_EQ(config.sensors[0].blend.unchanged_for_s, 43200.0);
  EXPECT_EQ(parse_config(to_toml(config), "recorded.toml").sensors[0].blend.unchanged_for_s, 43200.0)
      << "a recording is replayed so";
  const Config osc = parse_config("[[sensor]]\ndriver = \"osc\"\nsilence = 600\non_change = true\n", "wall.toml");
  EXPECT_EQ(osc.sensors[0].blend.unchanged_for_s, 600.0);
}

TEST(Config, WhatWasRecordedOfASensorSaysWhetherItSpokeOnChange) {
  const std::string sensor =
      "[[sensor]]\ndriver = \"mqtt\"\ntopic = \"wind\"\nsilence = 43200\npassword_env = \"SECRET\"\n";
  const auto recorded = [](const Config& config) {
    return recorded_source(config.sensors[0].driver->name, to_toml(config.sensors[0].values)).unchanged_for_s;
  };
  EXPECT_EQ(recorded(parse_config(sensor + "on_change = true\n", "wall.toml")), 43200.0);
  EXPECT_EQ(recorded(parse_config(sensor, "wall.toml")), 0.0);
  EXPECT_EQ(recorded_source("mqtt", "on_change = true\nsilence = 60.0\nof_later = 1\n").unchanged_for_s, 0.0);
  EXPECT_EQ(recorded_source("mqtt", "on_change =").unchanged_for_s, 0.0);
  EXPECT_EQ(recorded_source("synthetic", "speed = 5").unchanged_for_s, 0.0);
  EXPECT_EQ(recorded_source("a driver of later", "on_change = true").unchanged_for_s, 0.0);
}

TEST(Config, ASensorHasItsPartAmongSeveral) {
  const Config config = parse_config(
      "[wind]\nreturn_after = 20\n"
      "[[sensor]]\ndriver = \"synthetic\"\nname = \"roof\"\n"
      "[[sensor]]\ndriver = \"synthetic\"\nname = \"microphone\"\n[sensor.blend]\nrole = \"relative\"\n"
      "priority = 3\nweight = 2\nx = -4.5\nz = 2\naveraging = 600\ndirection_step = 22.5\n",
      "wall.toml");
  EXPECT_EQ(config.wind.return_after_s, 20.0);
  const wind::blend::SourceSettings& roof = config.sensors[0].blend;
  EXPECT_FALSE(roof.is_relative);
  EXPECT_EQ(roof.priority, 0);
  EXPECT_EQ(roof.weight, 1.0);
  const wind::blend::SourceSettings& microphone = config.sensors[1].blend;
  EXPECT_TRUE(microphone.is_relative);
  EXPECT_EQ(microphone.priority, 3);
  EXPECT_EQ(microphone.weight, 2.0);
  EXPECT_EQ(microphone.east_m, -4.5);
  EXPECT_EQ(microphone.south_m, 2.0);
  EXPECT_EQ(microphone.averaging_s, 600.0);
  EXPECT_EQ(microphone.direction_step_deg, 22.5);
  EXPECT_THAT(to_toml(config), HasSubstr("averaging = 600.0"));

  const std::string sensor = "[[sensor]]\ndriver = \"synthetic\"\n";
  EXPECT_THAT(mistakes_of(sensor + "[sensor.blend]\nrole = \"boss\"\n"),
              StartsWith("wall.toml:4:8: sensor.blend.role: is \"boss\"; allowed:"));
  EXPECT_THAT(mistakes_of(sensor + "[sensor.blend]\nweight = 0\n"),
              StartsWith("wall.toml:4:10: sensor.blend.weight: is 0; allowed: number from 0.01 to 100"));
  EXPECT_THAT(mistakes_of(sensor + "blend = 3\n"),
              StartsWith("wall.toml:3:9: sensor.blend: is a value; write it as a table"));
}

TEST(Config, WhereASensorStandsIsToldOrNotAndStaysSoWhenWrittenOut) {
  const std::string sensor = "[[sensor]]\ndriver = \"synthetic\"\n";
  const auto source_of = [](const Config& config) { return config.sensors.at(0).blend; };
  struct Case {
    const char* blend;
    bool has_place;
    double east_m, south_m, lead_m;
    const char* text;
  };
  for (const Case& one : {Case{"", false, 0.0, 0.0, 0.0, "at the windward edge of the scenes"},
                          Case{"weight = 2\nlead = 0\n", false, 0.0, 0.0, 0.0, "at the windward edge of the scenes"},
                          Case{"x = 0\n", true, 0.0, 0.0, 0.0, "in the middle of the scenes"},
                          Case{"z = -3\n", true, 0.0, -3.0, 0.0, "3 m north of the middle of the scenes"},
                          Case{"x = -12.5\nz = 3\nlead = 20\n", true, -12.5, 3.0, 20.0,
                               "12.5 m west and 3 m south of the middle of the scenes, taken 20 m upwind of there"}}) {
    const Config config = parse_config(sensor + "[sensor.blend]\n" + one.blend, "wall.toml");
    const std::string written = to_toml(config);
    const Config again = parse_config(written, "again.toml");
    EXPECT_EQ(to_toml(again), written) << one.blend;
    for (const wind::blend::SourceSettings& source : {source_of(config), source_of(again)}) {
      EXPECT_EQ(source.has_place, one.has_place) << one.blend;
      EXPECT_EQ(source.east_m, one.east_m) << one.blend;
      EXPECT_EQ(source.south_m, one.south_m) << one.blend;
      EXPECT_EQ(source.lead_m, one.lead_m) << one.blend;
      EXPECT_EQ(place_text(source), one.text) << one.blend;
    }
  }
  EXPECT_FALSE(source_of(default_config()).has_place);

  EXPECT_THAT(mistakes_of(sensor + "[sensor.blend]\nlead = 20\n"),
              StartsWith("wall.toml:4:8: sensor.blend.lead: needs the position of the sensor; give x or z"));
  EXPECT_THAT(mistakes_of(sensor + "[sensor.blend]\nx = 2000\n"),
              StartsWith("wall.toml:4:5: sensor.blend.x: is 2000; allowed: number from -1000 to 1000 m; left out: "));
  EXPECT_THAT(mistakes_of(sensor + "[sensor.blend]\nx = 0\nlead = -1\n"), HasSubstr("sensor.blend.lead: is -1"));
}

TEST(Config, ASceneOfAnyKindHasAPlaceAGainAndIsShownOrNot) {
  const Config config = parse_config(
      "[[scene]]\nkind = \"grass\"\nx = 3\nz = -2.5\nheading = 90\ngain = 1.5\nshown = false\nblades_across = 50\n"
      "[[scene]]\nkind = \"grass\"\nname = \"other\"\n",
      "wall.toml");
  const SceneConfig& placed = config.scenes[0];
  EXPECT_EQ(placed.placement.x_m, 3.0);
  EXPECT_EQ(placed.placement.y_m, 0.0);
  EXPECT_EQ(placed.placement.z_m, -2.5);
  EXPECT_EQ(placed.placement.heading_deg, 90.0);
  EXPECT_EQ(placed.wind_gain, 1.5);
  EXPECT_FALSE(placed.is_shown);
  EXPECT_EQ(config.scenes[1].wind_gain, 1.0);
  EXPECT_TRUE(config.scenes[1].is_shown);
  EXPECT_THAT(to_toml(config), HasSubstr("heading = 90.0"));

  EXPECT_THAT(mistakes_of("[[scene]]\nkind = \"grass\"\ngain = 11\n"),
              StartsWith("wall.toml:3:8: scene.gain: is 11; allowed: number from 0 to 10"));
  EXPECT_THAT(mistakes_of("[[scene]]\nkind = \"grass\"\nshown = 1\n"), StartsWith("wall.toml:3:9: scene.shown: "));
  EXPECT_THAT(mistakes_of("[[scene]]\nkind = \"grass\"\nxx = 1\n"), HasSubstr("heading"));
  EXPECT_THAT(mistakes_of("[stream]\ncontrol = \"me\"\n"), StartsWith("wall.toml:2:11: stream.control: "));
}

TEST(Config, NoKindOfSceneHasAParameterOfTheCommonNames) {
  for (const scenes::Description* scene : scenes::scene_table()) {
    for (const Parameter& own : scene->parameters) {
      for (const Parameter& common : common_scene_parameters()) EXPECT_NE(own.name, common.name) << scene->name;
      EXPECT_NE(own.name, "name") << scene->name;
      EXPECT_NE(own.name, "kind") << scene->name;
    }
  }
}

TEST(Config, AnAddressThatIsNoneIsAMistakeAtItsPlace) {
  EXPECT_THAT(mistakes_of("[stream]\nlisten = \"here\"\n"), StartsWith("wall.toml:2:10: stream.listen: "));
  EXPECT_THAT(mistakes_of("[stream]\nlisten = \"127.0.0.1:99999\"\n"), StartsWith("wall.toml:2:10: stream.listen: "));
}

TEST(Config, ABrokenFileIsToldWithLineAndColumn) {
  EXPECT_THAT(mistakes_of("seed = \n"), StartsWith("wall.toml:1:8: TOML: "));
  EXPECT_THAT(mistakes_of("seed = 1\nseed = 2\n"), StartsWith("wall.toml:2:"));
}

TEST(Config, AllMistakesOfAFileAreToldAtOnce) {
  const std::string told = mistakes_of("seed = -1\n[animation]\nrate = 0\n[stream]\nlisten = 7410\n");
  EXPECT_THAT(told, HasSubstr("wall.toml:1:8: seed"));
  EXPECT_THAT(told, HasSubstr("wall.toml:3:8: animation.rate"));
  EXPECT_THAT(told, HasSubstr("wall.toml:5:10: stream.listen"));
}

TEST(Config, AFileThatIsNotThereIsAMistakeOfTheConfiguration) {
  EXPECT_THROW(load_config("/nowhere/wall.toml"), ConfigError);
  EXPECT_THROW(load_config("/"), ConfigError);
}

TEST(Config, ASensorsJudgeHasLimitsOfItsOwnAndDefaults) {
  const Config config = parse_config(
      "[[sensor]]\ndriver = \"synthetic\"\n[sensor.judge]\nfrozen = 120\nseized = 600\n"
      "[[sensor]]\nname = \"free\"\ndriver = \"synthetic\"\n[sensor.judge]\nenabled = false\n"
      "[[sensor]]\nname = \"usual\"\ndriver = \"synthetic\"\n",
      "wall.toml");
  const std::optional<wind::judging::JudgeSettings>& strict = config.sensors[0].judge;
  ASSERT_TRUE(strict.has_value());
  EXPECT_EQ(strict->frozen_s, 120.0);
  EXPECT_EQ(strict->seized_s, 600.0);
  EXPECT_EQ(strict->seized_alone_s, 3600.0);
  EXPECT_FALSE(config.sensors[1].judge.has_value());
  const std::optional<wind::judging::JudgeSettings>& usual = config.sensors[2].judge;
  ASSERT_TRUE(usual.has_value());
  const wind::judging::JudgeSettings defaults;
  EXPECT_EQ(usual->max_speed_m_s, defaults.max_speed_m_s);
  EXPECT_EQ(usual->slew_m_s2, defaults.slew_m_s2);
  EXPECT_EQ(usual->least_spike_m_s, defaults.least_spike_m_s);
  EXPECT_EQ(usual->frozen_s, defaults.frozen_s);
  EXPECT_EQ(usual->seized_s, defaults.seized_s);
  EXPECT_EQ(usual->seized_alone_s, defaults.seized_alone_s);
}

TEST(Config, MistakesOfAJudgeAreToldAtTheirPlaces) {
  const std::string sensor = "[[sensor]]\ndriver = \"synthetic\"\n";
  EXPECT_THAT(mistakes_of(sensor + "judge = true\n"),
              HasSubstr("wall.toml:3:9: sensor.judge: is a value; write it as a table"));
  EXPECT_THAT(mistakes_of(sensor + "[sensor.judge]\nfrozen = 0\n"),
              HasSubstr("wall.toml:4:10: sensor.judge.frozen: is 0"));
  EXPECT_THAT(mistakes_of(sensor + "[sensor.judge]\nfreeze = 10\n"), HasSubstr("sensor.judge.freeze"));
}

constexpr std::string_view kMqttEntry = "[[sensor]]\ndriver = \"mqtt\"\ntopic = \"a\"\nuser = \"garden\"\n";

TEST(Config, APasswordIsNeverWrittenOut) {
  const Config config = parse_config(std::string(kMqttEntry) + "password = \"hunter2\"\n", "wall.toml");
  EXPECT_THAT(to_toml(config), Not(HasSubstr("hunter2")));
  EXPECT_THAT(to_toml(config), HasSubstr("password = '(secret)'"));
  EXPECT_THAT(to_toml(config.sensors[0].values), Not(HasSubstr("hunter2")));
  EXPECT_THAT(to_toml(config), HasSubstr("user = 'garden'")) << "only what is a secret";
}

TEST(Config, APasswordThatWasWithheldIsTakenAsNone) {
  const Config config = parse_config(std::string(kMqttEntry) + "password = \"hunter2\"\n", "wall.toml");
  const Config printed = parse_config(to_toml(config), "printed.toml");
  EXPECT_EQ(to_toml(printed), to_toml(config)) << "all else can still be read from it";
  EXPECT_THAT(
      [&] { open_sensor(printed.sensors[0]); },
      ThrowsMessage<ConfigError>(AllOf(StartsWith("printed.toml:"), HasSubstr("sensor: password: is \"(secret)\""))));
  const auto recorded = parse_values(to_toml(config.sensors[0].values), config.sensors[0].driver->parameters);
  ASSERT_TRUE(recorded);
  EXPECT_EQ(recorded->text("user"), "garden");
  EXPECT_THROW(static_cast<void>(recorded->secret("password")), std::runtime_error);
}

TEST(Config, APasswordThatCannotBeFoundIsToldAtTheSensor) {
  const Config config =
      parse_config("\n" + std::string(kMqttEntry) + "password_file = \"/nowhere/secret\"\n", "wall.toml");
  EXPECT_THAT([&] { open_sensor(config.sensors[0]); },
              ThrowsMessage<ConfigError>("wall.toml:2:1: sensor: password_file: \"/nowhere/secret\" does not exist"));
}

TEST(Config, ASecretIsNotWrittenByAnEdit) {
  const std::array changes{ConfigChange{.table = "", .key = "password", .value = Secret("hunter2")}};
  const auto edited = edit_sensor(kMqttEntry, "mqtt", changes);
  ASSERT_TRUE(edited.has_error());
  EXPECT_THAT(edited.error().message, AllOf(StartsWith("password: "), Not(HasSubstr("hunter2"))));
}

TEST(Config, TwoSensorsThatReadTheSameAreNotOpened) {
  const std::string sensor = "[[sensor]]\ndriver = \"hid\"\nname = ";
  const Config config = parse_config(sensor + "\"roof\"\n" + sensor + "\"mast\"\n", "wall.toml");
  EXPECT_THAT(
      [&] { open_sensors(config.sensors); },
      ThrowsMessage<ConfigError>("wall.toml:4:1: sensors \"roof\" and \"mast\" both read USB weather station: "
                                 "remove one of the sensors, or give them different settings (one of: station, path, "
                                 "serial)"));
}

TEST(HttpTable, OriginsAreAsBrowsersSendThem) {
  EXPECT_EQ(
      parse_config("[http]\norigins = 'http://127.0.0.1:5500 https://editor.p5js.org'\n", "a").http.origins.size(), 2U);
  for (const char* const origin :
       {"*", "null", "editor.p5js.org", "https://editor.p5js.org/", "https://Editor.p5js.org", "https://", "ftp://a",
        "https://a,https://b", "https://user@a"}) {
    EXPECT_THAT([&] { parse_config(fmt::format("[http]\norigins = '{}'\n", origin), "a"); },
                ThrowsMessage<ConfigError>(HasSubstr("is not an origin; allowed")))
        << origin;
  }
}

class SecretExposure : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text, mode_t mode) {
    std::string file = folder_ / name;
    std::ofstream(file) << text;
    EXPECT_EQ(chmod(file.c_str(), mode), 0);
    return file;
  }
  std::vector<std::string> warnings_of(const std::string& lines, mode_t mode) {
    const std::string file = write("wall.toml", std::string(kMqttEntry) + lines, mode);
    return exposed_secrets(load_config(file), file);
  }

  test::TemporaryFolder folder_;
};

TEST_F(SecretExposure, IsToldOfATokenThatOthersCanRead) {
  for (const auto& [mode, count] : {std::pair(0644U, 1U), std::pair(0640U, 0U)}) {
    const std::string token = write("token", "correct horse battery staple\n", mode);
    EXPECT_EQ(warnings_of("[http]\ntoken_file = \"" + token + "\"\n", 0640U).size(), count);
  }
}

TEST_F(SecretExposure, IsToldOfAConfigurationThatOthersCanRead) {
  const std::string file = folder_ / "wall.toml";
  for (const mode_t open : {0644U, 0604U, 0666U}) {
    EXPECT_THAT(warnings_of("password = \"hunter2\"\n", open),
                ElementsAre(fmt::format(
                    "{0}:1:1: sensor.password: everybody on this machine can read {0}; chmod 640 {0}", file)));
  }
  for (const mode_t closed : {0640U, 0600U, 0660U})
    EXPECT_THAT(warnings_of("password = \"hunter2\"\n", closed), IsEmpty());
  EXPECT_THAT(warnings_of("", 0644), IsEmpty()) << "there is no password in it";
}

TEST_F(SecretExposure, IsToldOfAFileOfASecretThatOthersCanRead) {
  const std::string secret = write("secret", "hunter2\n", 0644);
  const std::string line = "password_file = \"" + secret + "\"\n";
  EXPECT_THAT(warnings_of(line, 0644),
              ElementsAre(AllOf(HasSubstr("sensor.password_file: "), EndsWith("chmod 640 " + secret))));
  write("secret", "hunter2\n", 0640);
  EXPECT_THAT(warnings_of(line, 0644), IsEmpty());
}

TEST(Config, AMistakeInAPasswordDoesNotShowIt) {
  EXPECT_THAT(mistakes_of(std::string(kMqttEntry) + "password = 271828\n"),
              AllOf(StartsWith("wall.toml:5:12: sensor.password: is a whole number; allowed: "),
                    HasSubstr("text that is never printed"), Not(HasSubstr("271828"))));
}

TEST(Config, EveryTableIsATypeInTheUnitsOfItsMembers) {
  const Config config = parse_config(R"(
[stream]
max_clients = 5
max_clients_per_address = 2
control = "anywhere"
[animation]
threads = 3
[wind]
default_turbulence = 0.2
default_length = 0.5
gustiness = 0.4
evolving = false
handover = 4
stale_intervals = 6
relative_gains = false
fallback_recording = "good-day.windlog"
fallback_after = 90
[shaping]
floor = 1.5
site_median = 3
site_strong = 9
site_most_gain = 2
site_memory = 2
site_file = "site.json"
over = 60
ceiling = 15
ceiling_most = 20
closed = 0.25
fade = 30
)",
                                     "wall.toml");
  EXPECT_EQ(config.stream.max_clients, 5U);
  EXPECT_EQ(config.stream.max_clients_per_address, 2U);
  EXPECT_EQ(parse_config("", "").stream.max_clients_per_address, 8U);
  EXPECT_EQ(config.stream.control, ControlPermission::kAnywhere);
  EXPECT_EQ(parse_config("", "").stream.control, ControlPermission::kLoopback);
  EXPECT_EQ(parse_config("[stream]\ncontrol = \"nobody\"\n", "").stream.control, ControlPermission::kNobody);
  EXPECT_EQ(config.animation.threads, 3U);

  EXPECT_EQ(config.wind.default_turbulence_intensity, 0.2);
  EXPECT_EQ(config.wind.default_length_m, 1.0) << "no gusts are shorter";
  EXPECT_EQ(config.wind.gustiness, 0.4);
  EXPECT_FALSE(config.wind.is_evolving);
  EXPECT_EQ(config.wind.handover_s, 4.0);
  EXPECT_EQ(config.wind.stale_intervals, 6.0);
  EXPECT_FALSE(config.wind.has_relative_gains);
  EXPECT_TRUE(default_config().wind.has_relative_gains);
  ASSERT_TRUE(config.wind.fallback);
  EXPECT_EQ(config.wind.fallback->recording, "good-day.windlog");
  EXPECT_EQ(config.wind.fallback->after_s, 90.0);
  EXPECT_EQ(config.wind.fallback->origin, "wall.toml:16:22");
  EXPECT_FALSE(default_config().wind.fallback);
  EXPECT_FALSE(default_config().wind.default_length_m);

  const wind::shaping::WindShapingSettings& shaping = config.shaping.settings;
  EXPECT_EQ(shaping.floor_m_s, 1.5);
  EXPECT_EQ(shaping.site.median_m_s, 3.0);
  EXPECT_EQ(shaping.site.strong_m_s, 9.0);
  EXPECT_EQ(shaping.site.most_gain, 2.0);
  EXPECT_EQ(shaping.site_memory_s, 2.0 * 86400.0);
  EXPECT_EQ(shaping.over_s, 60.0);
  EXPECT_EQ(shaping.ceiling.from_m_s, 15.0);
  EXPECT_EQ(shaping.ceiling.most_m_s, 20.0);
  EXPECT_EQ(shaping.closed_level, 0.25);
  EXPECT_EQ(shaping.fade_s, 30.0);
  EXPECT_EQ(shaping.turbulence_intensity, 0.2) << "the breeze has that of the wind";
  EXPECT_EQ(shaping.length_m, 1.0);
  EXPECT_EQ(config.shaping.site_file, "site.json");
  EXPECT_TRUE(config.shaping.hours.is_always_open());
}

TEST(Config, AnotherAddressIsWrittenOutToo) {
  const Config config = listening_at(default_config(), "0.0.0.0:7411");
  EXPECT_EQ(config.stream.listen, "0.0.0.0:7411");
  EXPECT_EQ(parse_config(to_toml(config), "again.toml").stream.listen, "0.0.0.0:7411");
}

TEST(Config, ASensorOfNoFileHasTheDefaultsOfOneInAFile) {
  const Config config = parse_config("[[sensor]]\ndriver = \"microphone\"\n", "wall.toml");
  const SensorConfig& written = config.sensors[0];
  Config by_hand = config;
  by_hand.sensors = {default_sensor(written.name, *written.driver, written.values, "here")};
  EXPECT_EQ(by_hand.sensors[0].origin, "here");
  EXPECT_EQ(by_hand.sensors[0].blend.is_relative, written.blend.is_relative);
  EXPECT_TRUE(by_hand.sensors[0].judge.has_value());
  EXPECT_TRUE(by_hand.sensors[0].is_compared);
  EXPECT_EQ(to_toml(by_hand), to_toml(config));
}

TEST(Config, WrittenOutAndReadAgainItIsTheSame) {
  const Config config = parse_config("seed = 5\n[[sensor]]\ndriver = \"synthetic\"\nspeed = 2.25\n", "wall.toml");
  const std::string written = to_toml(config);
  EXPECT_EQ(to_toml(parse_config(written, "again.toml")), written);
  EXPECT_THAT(written, HasSubstr("speed = 2.25"));
}

TEST(Config, TheValuesOfOneTableAreReadBack) {
  const Config config = parse_config("[[sensor]]\ndriver = \"synthetic\"\nspeed = 2.25\n", "wall.toml");
  const SensorConfig& sensor = config.sensors[0];
  const auto again = parse_values(to_toml(sensor.values), sensor.driver->parameters);
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->all(), sensor.values.all());
  EXPECT_THAT(parse_values("speed = -1", sensor.driver->parameters).error().message, HasSubstr("speed: is -1"));
  EXPECT_THAT(parse_values("speed = [1]", sensor.driver->parameters).error().message, HasSubstr("takes one value"));
  EXPECT_THAT(parse_values("speed =", sensor.driver->parameters).error().message, HasSubstr("TOML"));
}

TEST(Config, EveryParameterHasAHelpAndADefaultWithinItsOwnRange) {
  const auto check = [](std::string_view where, std::span<const Parameter> parameters) {
    for (const Parameter& parameter : parameters) {
      EXPECT_FALSE(parameter.help.empty()) << where << " " << parameter.name;
      const ParameterValues::Map given{{std::string(parameter.name), parameter.default_value}};
      EXPECT_TRUE(ParameterValues::resolve(parameters, given).has_value()) << where << " " << parameter.name;
    }
  };
  for (const ConfigTable& table : config_tables()) check(table.name, table.parameters);
  check("scene", common_scene_parameters());
  for (const SensorTable& table : sensor_tables()) check(table.name, table.parameters);
  for (const drivers::sensor::DriverDescription* driver : drivers::sensor::driver_table())
    check(driver->name, driver->parameters);
  for (const scenes::Description* scene : scenes::scene_table()) check(scene->name, scene->parameters);
}

}  // namespace
}  // namespace yuragi::daemon::settings
