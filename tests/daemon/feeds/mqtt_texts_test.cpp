#include "daemon/feeds/mqtt_texts.hpp"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace yuragi::daemon::feeds {
namespace {

using nlohmann::json;
using settings::feeds::Mqtt;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;
using testing::StartsWith;
using values::Quantity;

values::Moment live_moment() {
  values::Moment moment;
  moment.utc = UtcTime(std::chrono::seconds(1'700'000'000));
  moment.source = wind::Source::kLive;
  return moment;
}

Mqtt config_of(bool takes_commands) {
  Mqtt config;
  config.topic = "yuragi/hall-2";
  config.every_s = 10.0;
  config.home_assistant = "homeassistant";
  config.takes_commands = takes_commands;
  return config;
}

MqttNames some_names() {
  return mqtt_names_of({.sensors = {"roof"}, .scenes = {"a b", "a_b"}},
                       {.alerts = {{.name = "storm"}}, .needs_attention = false});
}

TEST(MqttTextsTest, TheWindHasTheseKeys) {
  const WindWindow::Summary wind{.mean_m_s = 4.25, .strongest_3_s_m_s = 6.1234, .min_m_s = 1, .u_m_s = 4, .norm = 0.5};
  EXPECT_EQ(mqtt_wind_json(wind, 1.0, live_moment()),
            R"({"speed_m_s":4.25,"gust_m_s":6.123,"min_m_s":1.0,"direction_deg":270,"norm":0.5,"live":1.0,)"
            R"("source":"live","utc":"2023-11-14T22:13:20.000Z"})");
}

TEST(MqttTextsTest, ACalmHasNoDirection) {
  EXPECT_TRUE(json::parse(mqtt_wind_json({.u_m_s = 0.1}, 0.0, live_moment())).at("direction_deg").is_null());
  EXPECT_TRUE(json::parse(mqtt_fast_json({}, live_moment())).at("direction_deg").is_null());
}

TEST(MqttTextsTest, AlmostNorthIsZeroDegrees) {
  EXPECT_EQ(json::parse(mqtt_wind_json({.u_m_s = 0.001, .v_m_s = -5}, 0.0, live_moment())).at("direction_deg"), 0);
}

TEST(MqttTextsTest, WhatASensorDoesNotSendIsNull) {
  const json sensor = json::parse(mqtt_sensor_json({.speed_m_s = 3.0}));
  EXPECT_EQ(sensor.at("speed_m_s"), 3.0);
  EXPECT_TRUE(sensor.at("direction_deg").is_null());
  EXPECT_EQ(sensor.at("state"), "connecting");
}

TEST(MqttTextsTest, HomeAssistantIsToldAllEntities) {
  const json config = json::parse(
      home_assistant_config(config_of(true), {.id = "yuragi_1", .url = "http://192.168.1.5:7480/"}, some_names()));
  EXPECT_EQ(config.at("dev").at("configuration_url"), "http://192.168.1.5:7480/");
  EXPECT_EQ(config.at("dev").at("identifiers"), json::array({"yuragi_1"}));
  EXPECT_EQ(config.at("availability_topic"), "yuragi/hall-2/status");
  EXPECT_TRUE(config.at("o").contains("name"));
  std::vector<std::string> keys;
  for (const auto& [key, component] : config.at("cmps").items()) {
    keys.push_back(key);
    EXPECT_EQ(component.at("unique_id"), "yuragi_1_" + key);
    EXPECT_THAT(component.at("state_topic").get<std::string>(), StartsWith("yuragi/hall-2/"));
  }
  EXPECT_THAT(keys, ElementsAre("alert_storm", "direction", "gust", "measured", "problem", "scene_a_b", "scene_a_b_2",
                                "speed"));
  const json& speed = config.at("cmps").at("speed");
  EXPECT_EQ(speed.at("device_class"), "wind_speed");
  EXPECT_EQ(speed.at("state_class"), "measurement");
  EXPECT_EQ(speed.at("expire_after"), 60);
  EXPECT_EQ(speed.at("value_template"), "{{ value_json.speed_m_s }}");
  EXPECT_EQ(config.at("cmps").at("direction").at("state_class"), "measurement_angle");
  EXPECT_EQ(config.at("cmps").at("measured").at("device_class"), "connectivity");
  EXPECT_EQ(config.at("cmps").at("alert_storm").at("device_class"), "problem");
  EXPECT_EQ(config.at("cmps").at("scene_a_b").at("command_topic"), "yuragi/hall-2/scene/a_b/set");
}

TEST(MqttTextsTest, WithoutCommandsThereIsNoSwitchAndNothingIsSubscribedTo) {
  const json config = json::parse(home_assistant_config(config_of(false), {.id = "yuragi_1", .url = ""}, some_names()));
  EXPECT_FALSE(config.at("cmps").contains("scene_a_b"));
  EXPECT_FALSE(config.at("dev").contains("configuration_url"));
  EXPECT_THAT(mqtt_subscriptions(config_of(false), "yuragi_1"),
              ElementsAre("homeassistant/status", "homeassistant/device/yuragi_1/config"));
  EXPECT_THAT(mqtt_subscriptions(config_of(true), "yuragi_1"), Contains("yuragi/hall-2/scene/+/set"));
}

TEST(MqttTextsTest, WhatIsNoLongerThereIsRemoved) {
  const HomeAssistantDevice device{.id = "yuragi_1", .url = ""};
  const HomeAssistantEntities before =
      home_assistant_entities(home_assistant_config(config_of(true), device, some_names()));
  EXPECT_THAT(before, AllOf(Contains(Pair("scene_a_b", "switch")), Contains(Pair("alert_storm", "binary_sensor"))));
  MqttNames fewer = some_names();
  fewer.alerts.clear();
  fewer.alert_parts.clear();
  const json config = json::parse(home_assistant_config(config_of(false), device, fewer, before));
  EXPECT_EQ(config.at("cmps").at("alert_storm"), (json{{"platform", "binary_sensor"}}));
  EXPECT_EQ(config.at("cmps").at("scene_a_b"), (json{{"platform", "switch"}}));
  EXPECT_TRUE(config.at("cmps").at("speed").contains("unique_id"));
}

TEST(MqttTextsTest, WhatIsNoDiscoveryHasNoEntities) {
  for (const char* const text : {"", "{", "[]", "7", R"({"cmps": []})", R"({"cmps": {"a": 7, "b": {"platform": 7}}})"})
    EXPECT_THAT(home_assistant_entities(text), IsEmpty()) << text;
}

TEST(MqttTextsTest, ASlowWindExpiresLater) {
  Mqtt config = config_of(false);
  config.every_s = 600.0;
  const json told = json::parse(home_assistant_config(config, {.id = "yuragi_1", .url = ""}, some_names()));
  EXPECT_EQ(told.at("cmps").at("speed").at("expire_after"), 1800);
}

TEST(MqttTextsTest, TheIdDependsOnTheTopicAlone) {
  EXPECT_EQ(home_assistant_id("yuragi"), home_assistant_id("yuragi"));
  EXPECT_NE(home_assistant_id("yuragi"), home_assistant_id("yuragi/hall-2"));
}

TEST(MqttTextsTest, CommandsShowAndHideScenesAndNothingElse) {
  const Mqtt config = config_of(true);
  const MqttNames names = some_names();
  const auto command = [&](std::string_view topic, std::string_view payload) {
    return mqtt_command_of(config, names, topic, payload);
  };
  EXPECT_EQ(command("yuragi/hall-2/scene/a_b/set", "show"), (MqttCommand{.scene = "a b", .shown = true}));
  EXPECT_EQ(command("yuragi/hall-2/scene/a_b_2/set", "OFF"), (MqttCommand{.scene = "a_b", .shown = false}));
  EXPECT_EQ(command("homeassistant/status", "online"), MqttCommand());
  for (const auto& [topic, payload] :
       std::vector<std::pair<std::string, std::string>>{{"yuragi/hall-2/scene/a_b/set", "TOGGLE"},
                                                        {"yuragi/hall-2/scene/a b/set", "ON"},
                                                        {"yuragi/hall-2/scene/set", "ON"},
                                                        {"yuragi/hall-2/scene//set", "ON"},
                                                        {"yuragi/hall-2/wind", "ON"},
                                                        {"homeassistant/status", "offline"},
                                                        {"", ""}}) {
    EXPECT_EQ(command(topic, payload), std::nullopt) << topic << ' ' << payload;
  }
  EXPECT_EQ(mqtt_command_of(config_of(false), names, "yuragi/hall-2/scene/a_b/set", "ON"), std::nullopt);
}

}  // namespace
}  // namespace yuragi::daemon::feeds
