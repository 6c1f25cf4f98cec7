#include "daemon/feeds/mqtt_texts.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/feeds/component_id.hpp"
#include "daemon/feeds/osc_addresses.hpp"
#include "engine/base/json_text.hpp"
#include "engine/base/version.hpp"
#include "engine/math/philox.hpp"
#include "engine/wind/wind_vector.hpp"

namespace yuragi::daemon::feeds {
namespace {

using Json = nlohmann::ordered_json;
using values::Quantity;

/// Below this mean wind there is no direction.
constexpr double kCalm_m_s = 0.2;
constexpr double kExpireAfter_s = 60.0;

/// To a thousandth; null if it is not known.
Json number(double value) {
  if (!std::isfinite(value)) return nullptr;
  return std::round(1000.0 * value) / 1000.0;
}

/// Whole degrees; null in a calm.
Json direction(wind::Vector wind) {
  if (std::hypot(wind.u_m_s, wind.v_m_s) < kCalm_m_s) return nullptr;
  return static_cast<int>(std::lround(wind::direction_from_deg(wind))) % 360;
}

}  // namespace

std::string mqtt_wind_json(const WindWindow::Summary& wind, double live, const values::Moment& moment) {
  return json_text(Json{{"speed_m_s", number(wind.mean_m_s)},
                        {"gust_m_s", number(wind.strongest_3_s_m_s)},
                        {"min_m_s", number(wind.min_m_s)},
                        {"direction_deg", direction({wind.u_m_s, wind.v_m_s})},
                        {"norm", number(wind.norm)},
                        {"live", number(live)},
                        {"source", values::name_of(moment.source)},
                        {"utc", values::utc_text(moment.utc)}});
}

std::string mqtt_fast_json(const values::Readout& wind, const values::Moment& moment) {
  return json_text(Json{{"speed_m_s", number(wind[Quantity::kSpeed])},
                        {"direction_deg", direction({wind[Quantity::kU], wind[Quantity::kV]})},
                        {"u_m_s", number(wind[Quantity::kU])},
                        {"v_m_s", number(wind[Quantity::kV])},
                        {"norm", number(wind[Quantity::kNorm])},
                        {"gust_norm", number(wind[Quantity::kGustNorm])},
                        {"live", number(wind[Quantity::kLive])},
                        {"utc", values::utc_text(moment.utc)}});
}

std::string mqtt_sensor_json(const values::SensorValue& sensor) {
  return json_text(Json{{"speed_m_s", number(sensor.speed_m_s)},
                        {"direction_deg", number(sensor.direction_deg)},
                        {"age_s", number(sensor.age_s)},
                        {"state", wind::judging::name_of(sensor.state)}});
}

MqttNames mqtt_names_of(const values::Names& names, const values::Health& health) {
  MqttNames all{.sensors = names.sensors,
                .scenes = names.scenes,
                .alerts = {},
                .sensor_parts = osc_parts_of(names.sensors),
                .scene_parts = osc_parts_of(names.scenes),
                .alert_parts = {}};
  for (const values::AlertState& alert : health.alerts) all.alerts.push_back(alert.name);
  all.alert_parts = osc_parts_of(all.alerts);
  return all;
}

std::string home_assistant_id(const std::string& topic) {
  return fmt::format("yuragi_{:016x}", math::stream_id(machine_id() + topic));
}

std::string home_assistant_topic(const settings::feeds::Mqtt& config, const std::string& device_id) {
  return fmt::format("{}/device/{}/config", config.home_assistant, device_id);
}

std::string home_assistant_config(const settings::feeds::Mqtt& config, const HomeAssistantDevice& device,
                                  const MqttNames& names, const HomeAssistantEntities& before) {
  const std::string& topic = config.topic;
  Json components = Json::object();
  const auto add = [&](const std::string& key, const std::string& name, Json component) {
    component["name"] = name;
    component["unique_id"] = fmt::format("{}_{}", device.id, key);
    components[key] = std::move(component);
  };
  const double expire_after_s = std::max(kExpireAfter_s, std::ceil(3.0 * config.every_s));
  const auto add_wind = [&](const std::string& key, const std::string& name, const char* device_class, const char* unit,
                            const char* state_class, const char* value) {
    add(key, name,
        {{"platform", "sensor"},
         {"device_class", device_class},
         {"state_class", state_class},
         {"unit_of_measurement", unit},
         {"state_topic", topic + "/wind"},
         {"value_template", fmt::format("{{{{ value_json.{} }}}}", value)},
         {"expire_after", static_cast<int>(expire_after_s)}});
  };
  add_wind("speed", "Wind speed", "wind_speed", "m/s", "measurement", "speed_m_s");
  add_wind("gust", "Wind gust", "wind_speed", "m/s", "measurement", "gust_m_s");
  add_wind("direction", "Wind direction", "wind_direction", "°", "measurement_angle", "direction_deg");
  add("measured", "Wind is measured",
      {{"platform", "binary_sensor"},
       {"device_class", "connectivity"},
       {"entity_category", "diagnostic"},
       {"state_topic", topic + "/wind"},
       {"value_template", "{{ 'ON' if value_json.live > 0 else 'OFF' }}"},
       {"expire_after", static_cast<int>(expire_after_s)}});
  const auto add_problem = [&](const std::string& key, const std::string& name, const std::string& state_topic) {
    add(key, name,
        {{"platform", "binary_sensor"},
         {"device_class", "problem"},
         {"entity_category", "diagnostic"},
         {"state_topic", state_topic}});
  };
  add_problem("problem", "Problem", topic + "/problem");
  for (std::size_t i = 0; i < names.alerts.size(); ++i)
    add_problem("alert_" + names.alert_parts[i], names.alerts[i],
                fmt::format("{}/alert/{}", topic, names.alert_parts[i]));
  for (std::size_t i = 0; config.takes_commands && i < names.scenes.size(); ++i) {
    const std::string scene = fmt::format("{}/scene/{}", topic, names.scene_parts[i]);
    add("scene_" + names.scene_parts[i], names.scenes[i],
        {{"platform", "switch"}, {"state_topic", scene}, {"command_topic", scene + "/set"}});
  }
  // An entity with a platform alone is removed.
  for (const auto& [key, platform] : before) {
    if (!components.contains(key)) components[key] = {{"platform", platform}};
  }
  const std::size_t last_level = topic.rfind('/') + 1;  // 0 if there is one level
  Json dev{{"identifiers", {device.id}},
           {"name", topic == "yuragi" ? "Yuragi" : "Yuragi " + topic.substr(last_level)},
           {"manufacturer", "Yuragi"},
           {"model", "Wind for animations"},
           {"sw_version", kVersion}};
  if (!device.url.empty()) dev["configuration_url"] = device.url;
  return json_text(Json{{"dev", std::move(dev)},
                        {"o", {{"name", "yuragi"}, {"sw", kVersion}}},
                        {"availability_topic", topic + "/status"},
                        {"cmps", std::move(components)}});
}

HomeAssistantEntities home_assistant_entities(std::string_view discovery) {
  HomeAssistantEntities entities;
  const Json json = Json::parse(discovery, nullptr, false);
  const auto components = json.is_object() ? json.find("cmps") : json.end();
  if (components == json.end() || !components->is_object()) return entities;
  for (const auto& [key, component] : components->items()) {
    const auto platform = component.is_object() ? component.find("platform") : component.end();
    if (platform != component.end() && platform->is_string()) entities.emplace(key, platform->get<std::string>());
  }
  return entities;
}

std::vector<std::string> mqtt_subscriptions(const settings::feeds::Mqtt& config, const std::string& device_id) {
  std::vector<std::string> topics;
  if (!config.home_assistant.empty())
    topics = {config.home_assistant + "/status", home_assistant_topic(config, device_id)};
  if (config.takes_commands) topics.push_back(config.topic + "/scene/+/set");
  return topics;
}

std::optional<MqttCommand> mqtt_command_of(const settings::feeds::Mqtt& config, const MqttNames& names,
                                           std::string_view topic, std::string_view payload) {
  if (!config.home_assistant.empty() && topic == config.home_assistant + "/status")
    return payload == "online" ? std::optional(MqttCommand()) : std::nullopt;
  const std::string head = config.topic + "/scene/";
  constexpr std::string_view kTail = "/set";
  if (!config.takes_commands || !topic.starts_with(head) || !topic.ends_with(kTail)) return std::nullopt;
  topic.remove_prefix(head.size());
  if (topic.size() < kTail.size()) return std::nullopt;
  topic.remove_suffix(kTail.size());
  const auto scene = std::ranges::find(names.scene_parts, topic);
  if (scene == names.scene_parts.end()) return std::nullopt;
  const bool shows = payload == "show" || payload == "ON";
  if (!shows && payload != "hide" && payload != "OFF") return std::nullopt;
  return MqttCommand{.scene = names.scenes.at(static_cast<std::size_t>(scene - names.scene_parts.begin())),
                     .shown = shows};
}

}  // namespace yuragi::daemon::feeds
