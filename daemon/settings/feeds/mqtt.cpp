#include "daemon/settings/feeds/mqtt.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace yuragi::daemon::settings::feeds {
namespace {

constexpr std::size_t kMaxTopic = 200;

/// A topic to which messages can be published, and to which levels can be added (OASIS, MQTT 3.1.1, 4.7).
bool is_topic(const std::string& text) {
  const auto is_taken = [](char c) {
    return static_cast<unsigned char>(c) >= ' ' && c != '\x7F' && c != '+' && c != '#';
  };
  return !text.empty() && text.size() <= kMaxTopic && !text.starts_with('$') && !text.starts_with('/') &&
         !text.ends_with('/') && std::ranges::all_of(text, is_taken);
}

Result<std::string, Failure> checked_topic(const std::string& text) {
  if (is_topic(text)) return {boost::system::in_place_value, text};
  return Failure{
      fmt::format("is \"{}\"; a topic has 1 to {} characters, none of + and #, and begins and ends "
                  "without a slash: yuragi/hall-2",
                  text, kMaxTopic)};
}

Result<std::string, Failure> checked_prefix(const std::string& text) {
  if (text.empty()) return {boost::system::in_place_value, text};
  return checked_topic(text);
}

}  // namespace

const Fields<Mqtt>& mqtt_fields() {
  static const Fields<Mqtt> kFields{
      {{.name = "host",
        .default_value = std::string(),
        .help = "name or address of the broker to which the wind is published; empty: nothing is published"},
       &Mqtt::host},
      {{"port", "", std::int64_t{0}, 0, 65535, "the broker's port; 0: 1883, with TLS 8883"}, &Mqtt::port},
      {{.name = "user", .default_value = std::string(), .help = "the user name; empty: none"}, &Mqtt::user},
      {{.name = "password",
        .default_value = Secret(),
        .help = "the user's password; or password_file, which keeps it out of this file"},
       &Mqtt::password},
      {{.name = "password_file",
        .default_value = std::string(),
        .help = "a file that holds the password, at most 4096 bytes; its mode should be 0640 or stricter. It is read "
                "at each connection",
        .is_secret_file = true},
       &Mqtt::password_file},
      {{.name = "tls", .default_value = false, .help = "use TLS, and verify the broker"}, &Mqtt::uses_tls},
      {{.name = "ca_file",
        .default_value = std::string(),
        .help = "the CA certificate (PEM) of the broker; empty: those of the system"},
       &Mqtt::ca_file},
      {{.name = "topic",
        .default_value = std::string("yuragi"),
        .help = "stands before all topics: yuragi/hall-2; another one for each daemon"},
       &Mqtt::topic,
       checked_topic},
      {{.name = "every",
        .unit = "s",
        .default_value = 10.0,
        .min = 1.0,
        .max = 3600.0,
        .help = "TOPIC/wind has the mean, the strongest 3 s and the minimum of these seconds; 10 s: 8,640 messages a "
                "day"},
       &Mqtt::every_s},
      {{.name = "fast",
        .unit = "Hz",
        .default_value = 0.0,
        .min = 0.0,
        .max = 20.0,
        .help = "how often the present wind is sent to TOPIC/fast; 0: never"},
       &Mqtt::fast_hz},
      {{.name = "home_assistant",
        .default_value = std::string("homeassistant"),
        .help = "prefix of Home Assistant's discovery, by which it adds the device by itself; empty: no discovery"},
       &Mqtt::home_assistant,
       checked_prefix},
      {{.name = "commands",
        .default_value = false,
        .help = "scenes are shown and hidden by TOPIC/scene/NAME/set: everybody who may publish there can do it"},
       &Mqtt::takes_commands},
      {{.name = "wind",
        .default_value = std::string(values::kWindNames[0]),
        .help = "shaped: the wind that moves the scenes; real: the measured wind",
        .choices = values::kWindNames},
       &Mqtt::wind},
  };
  return kFields;
}

std::vector<ParameterError> fill_mqtt(Mqtt& mqtt, const ParameterValues& values) {
  mqtt = {};
  std::vector<ParameterError> errors = mqtt_fields().fill(mqtt, values.all());
  if (!mqtt.password.is_empty() && !mqtt.password_file.empty())
    errors.push_back({"password_file", "is set beside password; remove one of them"});
  return errors;
}

}  // namespace yuragi::daemon::settings::feeds
