// Any topic and payload that a broker can send to the feed. A command is for a scene of the installation, with nothing
// but shown or hidden.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "daemon/feeds/mqtt_texts.hpp"

using namespace yuragi::daemon;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const feeds::MqttNames kNames =
      feeds::mqtt_names_of({.sensors = {"roof"}, .scenes = {"meadow", "a b"}}, {.alerts = {{.name = "storm"}}});
  static const settings::feeds::Mqtt kConfig = [] {
    settings::feeds::Mqtt config;
    config.topic = "y";
    config.home_assistant = "ha";
    config.takes_commands = true;
    return config;
  }();
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const std::size_t end = std::min(text.find('\0'), text.size());
  const std::string_view topic = text.substr(0, end);
  const auto command = feeds::mqtt_command_of(kConfig, kNames, topic, text.substr(std::min(end + 1, text.size())));
  feeds::home_assistant_entities(text);
  if (command && !command->scene.empty() && std::ranges::count(kNames.scenes, command->scene) == 0) std::abort();
  if (command && command->scene.empty() != (topic == "ha/status")) std::abort();
  return 0;
}
