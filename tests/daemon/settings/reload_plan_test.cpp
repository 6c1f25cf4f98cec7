#include "daemon/settings/reload_plan.hpp"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "daemon/settings/sensor_blend.hpp"
#include "daemon/settings/shaping_config.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::daemon::settings {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

/// A configuration in which much is set, with a sensor that says this in its tables.
Config wall(const std::string& more = "") {
  return parse_config("[shaping]\nfloor = 1.5\n" + more, "wall.toml");
}

constexpr const char* kTwoSensors =
    "[[sensor]]\ndriver = \"synthetic\"\nname = \"roof\"\n[sensor.calibration]\ngain = 1.5\n"
    "[[sensor]]\ndriver = \"windlog\"\nname = \"tape\"\nfile = \"a.windlog\"\n"
    "[[scene]]\nkind = \"grass\"\n[[scene]]\nkind = \"flag\"\n";

TEST(ReloadPlan, AppliesTheLookAlsoWhereAKeyComesOrGoes) {
  const Config evening = wall();
  const Config morning = wall("[look]\ntime = \"06:30\"\nclouds = 0.5\n");
  const ReloadPlan plan = plan_reload(evening, morning, true);
  EXPECT_THAT(plan.applied, ElementsAre("[look] clouds: 0.3 -> 0.5", "[look] time: left out -> \"06:30\""));
  EXPECT_EQ(plan.next.look, morning.look);
  EXPECT_EQ(plan.next.look.solar_time_h, 6.5);
  EXPECT_EQ(plan_reload(morning, evening, true).next.look, evening.look);
}

TEST(ReloadPlan, AppliesCameras) {
  const Config running =
      wall("[[camera]]\nname = \"day\"\nfrom = \"09:00\"\n[[camera]]\nname = \"night\"\nheading = 10\n");
  const Config wanted =
      wall("[[camera]]\nname = \"night\"\nheading = 20\ndistance = 5\n[[camera]]\nname = \"dawn\"\nfrom = \"05:00\"\n");
  const ReloadPlan plan = plan_reload(running, wanted, true);
  EXPECT_THAT(plan.applied,
              ElementsAre("camera night: distance: left out -> 5.0", "camera night: heading: 10.0 -> 20.0",
                          "camera dawn: is new", "camera day: is gone"));
  EXPECT_THAT(plan.takes_restart, IsEmpty());
  EXPECT_FALSE(plan.changes_scenes);
  ASSERT_EQ(plan.next.cameras.size(), 2U);
  EXPECT_EQ(plan.next.cameras[0].camera, wanted.cameras[0].camera);
  EXPECT_EQ(plan.next.cameras[1].camera.from_h, 5.0);
  EXPECT_THAT(plan_reload(running, wall(), true).applied, ElementsAre("camera day: is gone", "camera night: is gone"));
}

TEST(ReloadPlan, AppliesAlerts) {
  const Config running = wall("[[alert]]\nname = \"a\"\ncommand = \"page\"\n");
  const Config wanted = wall(
      "[[alert]]\nname = \"a\"\ncommand = \"mail\"\nwebhook = \"http://s3cret/\"\n"
      "[[alert]]\nname = \"b\"\nwhen = \"no_frame\"\ncommand = \"page\"\n");
  const ReloadPlan plan = plan_reload(running, wanted, true);
  EXPECT_THAT(plan.applied,
              ElementsAre("alert a: command: another value", "alert a: webhook: '' -> '(secret)'", "alert b: is new"));
  ASSERT_EQ(plan.next.alerts.size(), 2U);
  EXPECT_EQ(plan.next.alerts[0].command, "mail");
}

TEST(ReloadPlan, TheCamerasFollowTheClocksOfAnotherZone) {
  const auto in_zone = [](const char* zone) {
    return parse_config(std::string("[shaping]\nzone = \"") + zone + "\"\n[[camera]]\nname = \"a\"\nfrom = \"05:00\"\n",
                        "wall.toml");
  };
  const ReloadPlan plan = plan_reload(in_zone("Asia/Tokyo"), in_zone("Europe/Berlin"), true);
  EXPECT_THAT(plan.applied, ElementsAre("[shaping] zone: \"Asia/Tokyo\" -> \"Europe/Berlin\""));
  EXPECT_EQ(plan.next.clock.zone_name(), "Europe/Berlin");
}

TEST(ReloadPlan, SaysThatViewersReadTheirOutputWhenTheyAreStarted) {
  const Config running = parse_config("[[output]]\n", "wall.toml");
  const Config wanted = parse_config("[[output]]\nrefreshes = 2\n", "wall.toml");
  const ReloadPlan plan = plan_reload(running, wanted, true);
  EXPECT_THAT(plan.takes_restart, ElementsAre("[[output]]: has changed; viewers read it when they are started"));
  EXPECT_TRUE(plan_reload(plan.next, wanted, true).takes_restart.empty());
}

TEST(ReloadPlan, OfTheSameConfigurationIsEmpty) {
  const Config config = wall(kTwoSensors);
  const ReloadPlan plan = plan_reload(config, wall(kTwoSensors), true);
  EXPECT_TRUE(plan.is_empty());
  EXPECT_FALSE(plan.changes_scenes);
  EXPECT_FALSE(plan.changes_shaping);
  EXPECT_EQ(to_toml(plan.next), to_toml(config));
}

TEST(ReloadPlan, AppliesShapingWithItsHours) {
  const Config wanted = parse_config("[shaping]\nfloor = 2\nhours = \"10:00-18:00\"\nsite_file = \"b.json\"\n", "b");
  const ReloadPlan plan = plan_reload(wall(), wanted, true);
  EXPECT_THAT(plan.applied, ElementsAre("[shaping] floor: 1.5 -> 2.0", "[shaping] hours: \"\" -> \"10:00-18:00\""));
  EXPECT_THAT(plan.takes_restart, ElementsAre("[shaping] site_file: \"\" -> \"b.json\""));
  EXPECT_TRUE(plan.changes_shaping);
  EXPECT_EQ(plan.next.shaping.settings.floor_m_s, 2.0);
  EXPECT_FALSE(plan.next.shaping.hours.is_always_open());
  EXPECT_TRUE(plan.next.shaping.site_file.empty());
}

TEST(ReloadPlan, AppliesCalibrationAndJudgingAndTheRateOfARecording) {
  const Config running = wall(kTwoSensors);
  const Config wanted = wall(
      "[[sensor]]\ndriver = \"synthetic\"\nname = \"roof\"\nspeed = 7.0\n[sensor.calibration]\ngain = 2\nheight = 4\n"
      "[sensor.judge]\nfrozen = 99\n[sensor.blend]\nx = 3\n"
      "[[sensor]]\ndriver = \"windlog\"\nname = \"tape\"\nfile = \"b.windlog\"\nrate = 4\n"
      "[[scene]]\nkind = \"grass\"\n[[scene]]\nkind = \"flag\"\n");
  const ReloadPlan plan = plan_reload(running, wanted, true);
  EXPECT_THAT(plan.applied,
              ElementsAre("sensor roof: [sensor.calibration] gain: 1.5 -> 2.0",
                          "sensor roof: [sensor.judge] frozen: 30.0 -> 99.0", "sensor tape: rate: 1.0 -> 4.0"));
  EXPECT_THAT(plan.takes_restart,
              ElementsAre(StartsWith("sensor roof: speed: "), "sensor roof: [sensor.calibration] height: 0.0 -> 4.0",
                          "sensor roof: [sensor.blend] x: left out -> 3.0",
                          "sensor tape: file: \"a.windlog\" -> \"b.windlog\""));
  const SensorConfig& roof = plan.next.sensors[0];
  EXPECT_EQ(roof.calibration.gain, 2.0);
  EXPECT_EQ(roof.calibration.height_factor, 1.0) << "as it was until the restart";
  EXPECT_EQ(roof.judge->frozen_s, 99.0);
  EXPECT_FALSE(roof.blend.has_place);
  EXPECT_EQ(roof.values.all(), running.sensors[0].values.all());
  EXPECT_EQ(plan.next.sensors[1].values.text("file"), "a.windlog");
  EXPECT_EQ(plan.next.sensors[1].values.number("rate"), 4.0);

  // What takes a restart is named again, until there was one.
  const ReloadPlan again = plan_reload(plan.next, wanted, true);
  EXPECT_THAT(again.applied, IsEmpty());
  EXPECT_EQ(again.takes_restart, plan.takes_restart);
}

TEST(ReloadPlan, NamesSensorsThatComeGoAndChangePlaces) {
  const Config running = wall(kTwoSensors);
  const Config wanted = wall(
      "[[sensor]]\ndriver = \"windlog\"\nname = \"tape\"\nfile = \"a.windlog\"\n"
      "[[sensor]]\ndriver = \"osc\"\nname = \"roof\"\n"
      "[[sensor]]\ndriver = \"synthetic\"\nname = \"yard\"\n"
      "[[scene]]\nkind = \"grass\"\n[[scene]]\nkind = \"flag\"\n");
  const ReloadPlan plan = plan_reload(running, wanted, true);
  EXPECT_THAT(plan.applied, ElementsAre("sensor roof: [sensor.calibration] gain: 1.5 -> 1.0"));
  EXPECT_THAT(plan.takes_restart, ElementsAre("sensor roof: driver: \"synthetic\" -> \"osc\"", "sensor yard: is new",
                                              "the order of the sensors"));
  ASSERT_EQ(plan.next.sensors.size(), 2U);
  EXPECT_EQ(plan.next.sensors[0].driver->name, "synthetic");
  EXPECT_THAT(plan_reload(wanted, running, true).takes_restart, ::testing::Contains("sensor yard: is gone"));
}

TEST(ReloadPlan, NoticesAPictureWhoseFileHasChanged) {
  const Config running = parse_config("[[scene]]\nkind = \"flag\"\nimage = \"crest.png\"\n", "wall.toml");
  Config wanted = running;
  EXPECT_FALSE(plan_reload(running, wanted, true).changes_scenes);
  wanted.scenes[0].cloth.image = std::make_shared<look::Image>(look::Image{1, 1, {1, 2, 3}});
  const ReloadPlan plan = plan_reload(running, wanted, true);
  EXPECT_TRUE(plan.changes_scenes);
  EXPECT_THAT(plan.applied, testing::Contains("scene flag: image: its file has changed"));
}

TEST(ReloadPlan, TakesAnotherPictureOfTheGround) {
  const Config running = parse_config("", "wall.toml");
  Config wanted = parse_config("[look]\nground_image = \"mats.png\"\nground_image_width = 2\n", "wall.toml");
  wanted.scenes.back().cloth.image = std::make_shared<look::Image>(look::Image{1, 1, {1, 2, 3}});
  const ReloadPlan plan = plan_reload(running, wanted, true);
  EXPECT_TRUE(plan.changes_scenes);
  EXPECT_EQ(plan.next.scenes.back().cloth, wanted.scenes.back().cloth);
  EXPECT_EQ(plan.next.look.ground_image_width_m, 2.0);
  EXPECT_THAT(plan.applied, testing::Contains("[look] ground_image: left out -> \"mats.png\""));
  EXPECT_THAT(plan.takes_restart, IsEmpty());
}

TEST(ReloadPlan, TakesScenesAsAWholeOrLeavesThem) {
  const Config running = wall(kTwoSensors);
  Config wanted = wall(
      "[[sensor]]\ndriver = \"synthetic\"\nname = \"roof\"\n[sensor.calibration]\ngain = 1.5\n"
      "[[sensor]]\ndriver = \"windlog\"\nname = \"tape\"\nfile = \"a.windlog\"\n"
      "[[scene]]\nkind = \"flag\"\nx = 2\n[[scene]]\nkind = \"tree\"\nname = \"elm\"\n");
  const ReloadPlan plan = plan_reload(running, wanted, true);
  EXPECT_THAT(plan.applied, ElementsAre("scene flag: x: 0.0 -> 2.0", "scene elm: is new", "scene grass: is gone"));
  EXPECT_THAT(plan.takes_restart, IsEmpty());
  EXPECT_TRUE(plan.changes_scenes);
  ASSERT_EQ(plan.next.scenes.size(), 2U);
  EXPECT_EQ(plan.next.scenes[0].placement.x_m, 2.0);

  const ReloadPlan later = plan_reload(running, wanted, false);
  EXPECT_THAT(later.applied, IsEmpty());
  EXPECT_EQ(later.takes_restart, plan.applied);
  EXPECT_FALSE(later.changes_scenes);
  EXPECT_EQ(to_toml(later.next), to_toml(running));
}

TEST(ReloadPlan, ShowsNoSecretAndNoLongValue) {
  const char* broker =
      "[[sensor]]\ndriver = \"mqtt\"\nname = \"roof\"\nhost = \"a\"\ntopic = \"wind\"\nuser = "
      "\"anna\"\npassword = ";
  const ReloadPlan plan = plan_reload(wall(std::string(broker) + "\"first secret\"\n"),
                                      wall(std::string(broker) + "\"second secret\"\n"), true);
  EXPECT_THAT(plan.takes_restart, ElementsAre("sensor roof: password: another value"));
  const std::string hours = "Mon 10:00-18:00, Tue 10:00-18:00, Wed 10:00-18:00, Thu 10:00-18:00";
  EXPECT_THAT(plan_reload(wall(), wall("hours = \"" + hours + "\"\n"), true).applied,
              ElementsAre("[shaping] hours: \"\" -> ..."));
}

// ---- the file ----

std::string mistake_of(const std::filesystem::path& file) {
  try {
    read_config_text(file);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(ConfigText, IsReadFromARegularFileOfSensibleSizeOnly) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder / "wall.toml";
  EXPECT_THAT(mistake_of(file), HasSubstr(":1:1: file: does not exist"));
  EXPECT_THAT(mistake_of(folder.path()), HasSubstr("not a regular file"));
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_THAT(mistake_of(folder / "pipe"), HasSubstr("not a regular file")) << "and nobody was waited for";

  std::ofstream(file) << "seed = 3\n";
  EXPECT_EQ(read_config_text(file), "seed = 3\n");
  std::filesystem::resize_file(file, kMaxConfig_bytes);
  EXPECT_EQ(read_config_text(file).size(), kMaxConfig_bytes);
  std::filesystem::resize_file(file, 1'000'000'000);  // a sparse one
  EXPECT_THAT(mistake_of(file), HasSubstr("is too large; allowed: up to 1 MB"));
}

TEST(LogConfig, HasALevel) {
  EXPECT_EQ(parse_config("", "wall.toml").log.level, LogLevel::kInfo);
  EXPECT_EQ(parse_config("[log]\nlevel = \"error\"\n", "wall.toml").log.level, LogLevel::kError);
  EXPECT_THROW(parse_config("[log]\nlevel = \"loud\"\n", "wall.toml"), ConfigError);
}

}  // namespace
}  // namespace yuragi::daemon::settings
