#include "daemon/tools/sensors/description_json.hpp"

#include <algorithm>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/tools/sensors/daemon_status.hpp"

namespace yuragi::daemon::tools::sensors {
namespace {

TEST(DaemonStatusText, BeginsWithTheVerdictAndWhatNeedsAttention) {
  DaemonStatus status{.address = "127.0.0.1:7410", .software = "yuragi 1.0"};
  status.scenes = {{.name = "meadow", .kind = "grass", .shown = false}, {.name = "lawn", .kind = "ground"}};
  status.sensors.animation = wire::AnimationStatus{
      .running_s = 200.0, .period_s = 0.016, .tick_s = 0.002, .scenes = {{"meadow", 0.0}, {"lawn", 0.0015}}};
  EXPECT_THAT(status_text(status),
              testing::StartsWith("yuragi 1.0 at 127.0.0.1:7410, running for 3 min 20 s: all is well\n"));
  EXPECT_THAT(status_text(status), testing::HasSubstr("scene meadow (grass): hidden\n"));
  EXPECT_THAT(status_text(status), testing::HasSubstr("animation: 2.00 ms of work in each 16.00 ms"));
  EXPECT_THAT(status_text(status),
              testing::HasSubstr("scene lawn (ground): shown, 1.50 ms a tick, 75 % of the animation's work\n"));
  EXPECT_EQ(status_json(status)["verdict"], "well");
  EXPECT_EQ(status_json(status)["running_s"], 200.0);
  EXPECT_EQ(status_json(status)["animation"]["carried_times"], 4.0);
  EXPECT_EQ(status_json(status)["animation"]["scenes"][1]["share"], 0.75);

  status.sensors.recorder = wire::RecorderStatus{.lost = 3};
  EXPECT_THAT(status_text(status),
              testing::HasSubstr(": needs attention\n  - the recorder has dropped 3 readings since the start\n"));
  EXPECT_EQ(status_json(status)["verdict"], "attention");
  EXPECT_EQ(status_json(status)["attention"].size(), 1U);
}

TEST(DescriptionJson, HasEachKeyOfEachDriverAndNoSecret) {
  const auto drivers = drivers::sensor::driver_table();
  const nlohmann::ordered_json json = drivers_json(drivers);
  ASSERT_EQ(json.size(), drivers.size());
  for (std::size_t i = 0; i < drivers.size(); ++i) {
    EXPECT_EQ(json[i]["name"], drivers[i]->name);
    ASSERT_EQ(json[i]["parameters"].size(), drivers[i]->parameters.size());
    for (std::size_t k = 0; k < drivers[i]->parameters.size(); ++k) {
      EXPECT_EQ(json[i]["parameters"][k]["name"], drivers[i]->parameters[k].name);
      EXPECT_EQ(json[i]["parameters"][k]["help"], drivers[i]->parameters[k].help);
    }
  }
  const auto modbus = std::ranges::find(json, "modbus", [](const auto& driver) { return driver["name"]; });
  ASSERT_NE(modbus, json.end());
  const auto& devices = (*modbus)["known_devices"];
  const auto wm80 = std::ranges::find(devices, "vaisala-wm80", [](const auto& device) { return device["name"]; });
  ASSERT_NE(wm80, devices.end());
  EXPECT_EQ((*wm80)["confirmed_by"], nlohmann::ordered_json::array({"maker"}));
  EXPECT_THAT((*wm80)["unconfirmed"].get<std::string>(), testing::HasSubstr("slave id"));
  EXPECT_EQ((*wm80)["value"]["value"], "instant");
  EXPECT_TRUE((*wm80)["value"]["averaging_s"].is_null());
  EXPECT_THAT((*wm80)["value"]["source"].get<std::string>(), testing::HasSubstr("M212995EN"));
  EXPECT_TRUE(json[0]["known_devices"].is_array());
  const Parameter parameter{.name = "height", .unit = "m", .default_value = 2.0, .min = 0.0, .help = "how high"};
  const auto one = parameters_json(std::span(&parameter, 1))[0];
  EXPECT_EQ(one["unit"], "m");
  EXPECT_EQ(one["default"], 2.0);
  EXPECT_EQ(one["min"], 0.0);
  EXPECT_TRUE(one["max"].is_null());
  EXPECT_EQ(one["type"], "number");
}

}  // namespace
}  // namespace yuragi::daemon::tools::sensors
