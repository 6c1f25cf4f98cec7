#include "drivers/mqtt/home_assistant.hpp"

#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/mqtt/broker_search.hpp"
#include "tests/support/mosquitto_broker.hpp"

namespace yuragi::drivers::mqtt {
namespace {

using testing::HasSubstr;

// As ESPHome announces its component tx20, in abbreviations (esphome mqtt_component.cpp, mqtt_sensor.cpp).
constexpr const char* kEsphomeSpeedTopic = "homeassistant/sensor/roof/wind_speed/config";
constexpr const char* kEsphomeSpeed =
    R"({"unit_of_meas":"km/h","stat_cla":"measurement","name":"Wind Speed","ic":"mdi:weather-windy",)"
    R"("stat_t":"roof/sensor/wind_speed/state","avty_t":"roof/status","uniq_id":"ESPsensorwind_speed",)"
    R"("dev":{"ids":"a4cf12","name":"roof","sw":"esphome v2024.6","mdl":"esp32dev","mf":"espressif"}})";
constexpr const char* kEsphomeDirectionTopic = "homeassistant/sensor/roof/wind_direction_degrees/config";
constexpr const char* kEsphomeDirection =
    R"({"unit_of_meas":"°","name":"Wind Direction Degrees","stat_t":"roof/sensor/wind_direction_degrees/state",)"
    R"("uniq_id":"ESPsensorwind_direction_degrees","dev":{"ids":"a4cf12","name":"roof"}})";

AnnouncedValue one_in(std::string_view topic, std::string_view payload) {
  const auto values = announced_in(topic, payload);
  EXPECT_EQ(values.size(), 1U) << payload;
  return values.empty() ? AnnouncedValue() : values.front();
}
/// The pointer that a template stands for; its trouble where it cannot be read.
std::string place_of(const std::string& value_template) {
  const AnnouncedValue value = one_in("homeassistant/sensor/x/config",
                                      R"({"dev_cla":"wind_speed","unit_of_meas":"m/s","stat_t":"a","val_tpl":)" +
                                          quoted_for_toml(value_template) + "}");
  return value.trouble.empty() ? value.pointer : value.trouble;
}

TEST(HomeAssistant, AnnouncesWhatEsphomeMeasures) {
  const AnnouncedValue speed = one_in(kEsphomeSpeedTopic, kEsphomeSpeed);
  EXPECT_EQ(speed.kind, AnnouncedKind::kSpeed);
  EXPECT_EQ(speed.topic, "roof/sensor/wind_speed/state");
  EXPECT_EQ(speed.pointer, "");
  EXPECT_EQ(speed.unit, "km/h");
  EXPECT_EQ(speed.trouble, "");
  const AnnouncedValue direction = one_in(kEsphomeDirectionTopic, kEsphomeDirection);
  EXPECT_EQ(direction.kind, AnnouncedKind::kDirection);
  EXPECT_EQ(direction.device, speed.device);

  const auto found = announced_anemometers(std::vector{speed, direction}, "host = \"10.0.0.2\"\n");
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].what, "roof, Wind Speed (homeassistant/sensor/roof/wind_speed)");
  EXPECT_EQ(found[0].settings,
            "host = \"10.0.0.2\"\ntopic = \"roof/sensor/wind_speed/state\"\n"
            "direction_topic = \"roof/sensor/wind_direction_degrees/state\"\nspeed_unit = \"km/h\"\n");
}

TEST(HomeAssistant, AnnouncesValuesInOneJsonMessageWithABaseTopic) {
  std::vector<AnnouncedValue> values;
  for (
      const auto& [object, rest] :
      {std::pair{
           "speed",
           R"("device_class":"wind_speed","unit_of_measurement":"m/s","value_template":"{{ value_json.wind.speed }}")"},
       {"gust",
        R"("device_class":"wind_speed","unit_of_measurement":"m/s","value_template":"{{ value_json.wind.gust | float }}")"},
       {"dir",
        R"("device_class":"wind_direction","unit_of_measurement":"°","value_template":"{{ value_json['wind']['dir'] }}")"}}) {
    values.push_back(one_in(std::string("homeassistant/sensor/garden_") + object + "/config",
                            R"({"~":"stations/garden","state_topic":"~/state","device":{"identifiers":["g1"]},)" +
                                std::string(rest) + "}"));
  }
  EXPECT_EQ(values[1].kind, AnnouncedKind::kGust);
  const auto found = announced_anemometers(values, "");
  ASSERT_EQ(found.size(), 1U) << "a gust is no anemometer of its own";
  EXPECT_EQ(found[0].settings,
            "topic = \"stations/garden/state\"\nspeed_path = \"/wind/speed\"\n"
            "direction_topic = \"stations/garden/state\"\ndirection_path = \"/wind/dir\"\n"
            "gust_topic = \"stations/garden/state\"\ngust_path = \"/wind/gust\"\nspeed_unit = \"m/s\"\n");
}

TEST(HomeAssistant, AnnouncesAWholeDeviceAtOnce) {
  const auto values = announced_in(
      "homeassistant/device/mast/config",
      R"({"dev":{"ids":"m1","name":"mast"},"o":{"name":"x"},"stat_t":"mast/state","cmps":{)"
      R"("s":{"p":"sensor","dev_cla":"wind_speed","unit_of_meas":"kn","val_tpl":"{{ value_json.s }}","uniq_id":"s"},)"
      R"("t":{"p":"sensor","dev_cla":"temperature","unit_of_meas":"°C","val_tpl":"{{ value_json.t }}","uniq_id":"t"},)"
      R"("d":{"p":"sensor","dev_cla":"wind_direction","unit_of_meas":"°","val_tpl":"{{ value_json.d }}","uniq_id":"d"},)"
      R"("b":{"p":"button","dev_cla":"wind_speed"}}})");
  const auto found = announced_anemometers(values, "");
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].settings,
            "topic = \"mast/state\"\nspeed_path = \"/s\"\ndirection_topic = \"mast/state\"\ndirection_path = \"/d\"\n"
            "speed_unit = \"kn\"\n");
}

TEST(HomeAssistant, AnnouncesOtherThingsThanWind) {
  for (const char* const payload :
       {"", "7", "[]", "{}", R"({"dev_cla":"temperature","unit_of_meas":"°C","stat_t":"a","name":"wind chill"})",
        R"({"unit_of_meas":"km/h","stat_t":"a","name":"car"})", R"({"unit_of_meas":"°","stat_t":"a","name":"sun"})"}) {
    EXPECT_TRUE(announced_in("homeassistant/sensor/x/config", payload).empty()) << payload;
  }
  const char* const wind = R"({"dev_cla":"wind_speed","unit_of_meas":"m/s","stat_t":"a"})";
  EXPECT_TRUE(announced_in("homeassistant/switch/x/config", wind).empty());
  EXPECT_TRUE(announced_in("homeassistant/sensor/x/state", wind).empty());
}

TEST(HomeAssistant, SaysTheValueByATemplate) {
  EXPECT_EQ(place_of(""), "");
  EXPECT_EQ(place_of("{{ value }}"), "");
  EXPECT_EQ(place_of("{{value|float}}"), "");
  EXPECT_EQ(place_of("{{ value_json.wind_avg_m_s }}"), "/wind_avg_m_s");
  EXPECT_EQ(place_of("{{ value_json.TX23.Speed.Act | float(0) | round(1) }}"), "/TX23/Speed/Act");
  EXPECT_EQ(place_of(R"({{ value_json["a/b"][0]['c~'] }})"), "/a~1b/0/c~0");
  for (const char* const other :
       {"{{ value_json.a * 3.6 }}", "{{ (value|float * 3.6) | round(2) }}", "{% if value_json.a %}1{% endif %}", "7",
        "{{ value_json }}", "{{ value_json.a | default(0) }}", "{{ value_json.a }} km/h", "{{ states('x') }}"}) {
    EXPECT_THAT(place_of(other), HasSubstr("a template that is not supported")) << other;
  }
}

TEST(HomeAssistant, IsToldWithItsTroubleWhereItCannotBeRead) {
  const auto trouble_of = [](const std::string& rest) {
    const auto found = announced_anemometers(
        announced_in("homeassistant/sensor/x/config", R"({"dev_cla":"wind_speed")" + rest + "}"), "");
    EXPECT_EQ(found.size(), 1U);
    EXPECT_THAT(found[0].remedy, HasSubstr("yuragi sensors describe mqtt"));
    EXPECT_EQ(found[0].settings, "");
    return found[0].trouble;
  };
  EXPECT_THAT(trouble_of(R"(,"stat_t":"a","unit_of_meas":"Beaufort")"), HasSubstr("\"Beaufort\" is not one of m/s"));
  EXPECT_THAT(trouble_of(R"(,"unit_of_meas":"m/s")"), HasSubstr("topic"));
  EXPECT_THAT(trouble_of(R"(,"unit_of_meas":"m/s","stat_t":"a/#")"), HasSubstr("topic"));
  EXPECT_THAT(trouble_of(R"(,"unit_of_meas":"m/s","stat_t":"a\nb = 1")"), HasSubstr("topic"));
  EXPECT_THAT(trouble_of(R"(,"unit_of_meas":"m/s","stat_t":")" + std::string(60'000, 'a') + "\""), HasSubstr("topic"));
}

TEST(HomeAssistant, TextCannotLeaveItsQuotes) {
  EXPECT_EQ(quoted_for_toml("a\"\nhost = \"evil\\"), R"("a\"?host = \"evil\\")");
  EXPECT_EQ(quoted_for_toml("\xff\x1b[2J\x7f"), R"("??[2J?")");
}

TEST(HomeAssistant, TakesNoDirectionOfAnotherDeviceAndNoGustInAnotherUnit) {
  const std::vector<AnnouncedValue> values = {
      one_in(kEsphomeSpeedTopic, kEsphomeSpeed),
      one_in("homeassistant/sensor/y/config",
             R"({"dev_cla":"wind_direction","unit_of_meas":"°","stat_t":"other","dev":{"ids":"another"}})"),
      one_in("homeassistant/sensor/roof/gust/config",
             R"({"dev_cla":"wind_speed","unit_of_meas":"m/s","stat_t":"gust","dev":{"ids":"a4cf12"}})")};
  EXPECT_EQ(announced_anemometers(values, "")[0].settings,
            "topic = \"roof/sensor/wind_speed/state\"\nspeed_unit = \"km/h\"\n");
}

TEST(HomeAssistant, StandsAnyBytes) {
  std::mt19937_64 random(20261123);
  int found = 0;
  for (int round = 0; round < 100'000; ++round) {
    std::string hurt =
        round % 2 == 0 ? kEsphomeSpeed : R"({"dev_cla":"wind_speed","val_tpl":"{{ value_json.a['b'] | round(1) }}"})";
    for (int change = static_cast<int>(random() % 4); change > 0; --change)
      hurt[random() % hurt.size()] = static_cast<char>(random());
    const auto devices = announced_anemometers(announced_in(kEsphomeSpeedTopic, hurt), "");
    found += devices.empty() ? 0 : 1;
    for (const sensor::FoundDevice& device : devices)
      EXPECT_TRUE(std::ranges::none_of(device.what + device.trouble,
                                       [](char c) { return static_cast<unsigned char>(c) < ' '; }));
  }
  EXPECT_GT(found, 10'000);
}

TEST(BrokerSearch, FindsWhatIsRetainedOnARealBroker) {
  const MosquittoBroker broker;
  broker.publish(kEsphomeSpeedTopic, kEsphomeSpeed, {"-r"});
  broker.publish(kEsphomeDirectionTopic, kEsphomeDirection, {"-r"});
  broker.publish("homeassistant/sensor/cellar/config", R"({"dev_cla":"temperature","stat_t":"c"})", {"-r"});
  broker.publish("homeassistant/sensor/short/config", R"({"dev_cla":"wind_speed","unit_of_meas":"mph","stat_t":"s"})",
                 {"-r"});
  BrokerSearch search;
  search.broker.host = "127.0.0.1";
  search.broker.port = broker.port();
  const auto found = find_announced(search);
  ASSERT_TRUE(found.has_value()) << found.error().message;
  ASSERT_EQ(found->size(), 2U);
  search.prefix = "elsewhere";
  EXPECT_TRUE(find_announced(search).value().empty());
}

TEST(BrokerSearch, SaysWhyABrokerCannotBeAsked) {
  BrokerSearch search;
  search.broker.host = "127.0.0.1";
  search.broker.port = free_port(SOCK_STREAM);
  const auto found = find_announced(search);
  ASSERT_FALSE(found.has_value());
  EXPECT_THAT(found.error().message, HasSubstr("check its address"));
}

}  // namespace
}  // namespace yuragi::drivers::mqtt
