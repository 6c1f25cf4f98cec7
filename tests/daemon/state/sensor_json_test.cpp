#include "daemon/state/sensor_json.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace yuragi::daemon::state {
namespace {

TEST(SensorJson, HasNumbersAsNumbersAndNullWhereNothingIsKnown) {
  wire::SensorStatus sensor;
  sensor.name = "roof \"north\"";
  sensor.state = wind::judging::SensorState::kStale;
  sensor.speed_m_s = 8.5;
  sensor.reads_times_group = 1.25;
  sensor.refused = {{"timeout", 3}};
  wire::Sensors sensors;
  sensors.sensors = {sensor};
  sensors.wind.wind = {.u_m_s = -4.0, .v_m_s = 0.0};
  sensors.gust_reach_across = 1.5;
  sensors.feeds = {{.kind = "osc", .name = "wall", .target = "127.0.0.1:9000", .sends = "wind", .messages = 7}};
  sensors.recorder = wire::RecorderStatus{.state = wire::RecorderState::kHanging,
                                          .written = 12,
                                          .clock_doubt = "the clock is doubted",
                                          .recorded_elsewhere = 3};

  const auto json = nlohmann::ordered_json::parse(sensors_json(sensors).dump());
  const auto& first = json["sensors"].at(0);
  EXPECT_EQ(first["name"], "roof \"north\"");
  EXPECT_EQ(first["state"], "stale");
  EXPECT_EQ(first["speed_m_s"], 8.5);
  EXPECT_EQ(first["reads_times_group"], 1.25);
  EXPECT_TRUE(first["direction_deg"].is_null());
  EXPECT_TRUE(first["age_s"].is_null()) << "it has no reading";
  EXPECT_TRUE(first["interval_s"].is_null());
  EXPECT_EQ(first["refused"]["timeout"], 3);
  EXPECT_EQ(json["wind"]["speed_m_s"], 4.0);
  EXPECT_EQ(json["wind"]["direction_deg"], 90.0);
  EXPECT_EQ(json["wind"]["source"], "default");
  EXPECT_EQ(json["gust_reach"]["across"], 1.5);
  EXPECT_TRUE(json["gust_reach"]["along"].is_null());
  EXPECT_EQ(json["feeds"].at(0)["target"], "127.0.0.1:9000");
  EXPECT_EQ(json["feeds"].at(0)["messages"], 7);
  EXPECT_TRUE(json["feeds"].at(0)["last_sent_age_s"].is_null());
  EXPECT_EQ(json["recorder"]["state"], "hanging");
  EXPECT_TRUE(json["recorder"]["free_bytes"].is_null());
  EXPECT_EQ(json["recorder"]["clock_doubt"], "the clock is doubted");
  EXPECT_EQ(json["recorder"]["recorded_elsewhere"], 3);
  EXPECT_TRUE(json["io_lateness"].is_null());
  EXPECT_TRUE(json["animation"].is_null());
  EXPECT_TRUE(sensors_json(wire::Sensors{})["recorder"].is_null());
  EXPECT_TRUE(sensors_json(wire::Sensors{})["wind"]["direction_deg"].is_null()) << "still air has none";
}

TEST(SensorJson, SurvivesAStateOfANewerDaemon) {
  wire::Sensors sensors;
  sensors.sensors.resize(1);
  sensors.sensors[0].state = static_cast<wind::judging::SensorState>(200);
  sensors.recorder = wire::RecorderStatus{.state = static_cast<wire::RecorderState>(9)};
  EXPECT_TRUE(sensors_json(sensors)["recorder"]["state"].is_null());
  EXPECT_EQ(sensors_json(sensors)["sensors"][0]["state"], "?");
}

TEST(SensorJson, WritesTheBytesOfAMessageAsDigits) {
  const wire::RawTrace trace{.sensor = "roof", .utc_ns = 5, .bytes = {0x01, 0xff}, .length = 2};
  EXPECT_EQ(raw_trace_json(trace)["hex"], "01ff");
  EXPECT_EQ(raw_trace_json(trace)["length_bytes"], 2);
}

TEST(SensorJson, SaysNothingOfARecordingThatCannotBeRead) {
  const auto json = players_json({{.sensor = "a", .file = "a.windlog", .is_open = false, .refusal = ""}});
  EXPECT_TRUE(json[0]["position_s"].is_null());
  EXPECT_EQ(json[0]["is_open"], false);
}

}  // namespace
}  // namespace yuragi::daemon::state
