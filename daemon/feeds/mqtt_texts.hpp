#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/feeds/wind_window.hpp"
#include "daemon/settings/feeds/mqtt.hpp"
#include "daemon/values/moment.hpp"

namespace yuragi::daemon::feeds {

/// TOPIC/wind: {speed_m_s, gust_m_s, min_m_s, direction_deg, norm, live, source, utc}; direction_deg is null in a calm.
std::string mqtt_wind_json(const WindWindow::Summary& wind, double live, const values::Moment& moment);

/// TOPIC/fast: {speed_m_s, direction_deg, u_m_s, v_m_s, norm, gust_norm, live, utc}.
std::string mqtt_fast_json(const values::Readout& wind, const values::Moment& moment);

/// TOPIC/sensor/NAME: {speed_m_s, direction_deg, age_s, state}; what it does not send is null.
std::string mqtt_sensor_json(const values::SensorValue& sensor);

/// The names of an installation, as they stand in topics.
struct MqttNames {
  std::vector<std::string> sensors = {}, scenes = {}, alerts = {};                 ///< as they are
  std::vector<std::string> sensor_parts = {}, scene_parts = {}, alert_parts = {};  ///< parts of topics, no two alike
};
MqttNames mqtt_names_of(const values::Names& names, const values::Health& health);

/// The device as Home Assistant knows it.
struct HomeAssistantDevice {
  std::string id = {};   ///< "yuragi_0123456789abcdef", the same for the life of the installation
  std::string url = {};  ///< of the page; empty: there is none
};

/// An ID that depends on this machine and the topic alone. Reads /etc/machine-id, which it does not disclose.
std::string home_assistant_id(const std::string& topic);

/// The topic of a device's discovery, which is retained: PREFIX/device/ID/config.
std::string home_assistant_topic(const settings::feeds::Mqtt& config, const std::string& device_id);

/// Entities of Home Assistant: the kind of each ("binary_sensor") by its key.
using HomeAssistantEntities = std::map<std::string, std::string>;

/// The discovery of a device with all its entities (Home Assistant 2024.11 and later), which removes those of `before`
/// that are no longer there.
std::string home_assistant_config(const settings::feeds::Mqtt& config, const HomeAssistantDevice& device,
                                  const MqttNames& names, const HomeAssistantEntities& before = {});

/// The entities in a discovery that was published before; none if it is not one. Never throws for any bytes.
HomeAssistantEntities home_assistant_entities(std::string_view discovery);

/// What a message that came in asks for.
struct MqttCommand {
  std::string scene = {};  ///< its name; empty: the states are wanted again, because Home Assistant has started
  bool shown = false;
  friend bool operator==(const MqttCommand&, const MqttCommand&) = default;
};

/// What is subscribed to.
std::vector<std::string> mqtt_subscriptions(const settings::feeds::Mqtt& config, const std::string& device_id);

/// Reads a message of a topic of mqtt_subscriptions(); nullopt if it means nothing here. Never throws for any bytes.
std::optional<MqttCommand> mqtt_command_of(const settings::feeds::Mqtt& config, const MqttNames& names,
                                           std::string_view topic, std::string_view payload);

}  // namespace yuragi::daemon::feeds
