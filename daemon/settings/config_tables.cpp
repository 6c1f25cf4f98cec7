#include <algorithm>
#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "daemon/settings/config.hpp"
#include "engine/base/fields.hpp"

namespace yuragi::daemon::settings {
namespace {

const Fields<Config>& general_fields() {
  static const Fields<Config> kFields{
      {{.name = "seed",
        .default_value = std::int64_t{1},
        .min = 0,
        .help = "seed of all random numbers: the same seed and wind give the same motion"},
       &Config::seed},
  };
  return kFields;
}

const Fields<AnimationConfig>& animation_fields() {
  static const Fields<AnimationConfig> kFields{
      {{.name = "rate", .unit = "Hz", .default_value = 60.0, .min = 1.0, .max = 240.0, .help = "ticks per second"},
       &AnimationConfig::rate_hz},
      {{.name = "threads",
        .default_value = std::int64_t{1},
        .min = 1,
        .max = 64,
        .help = "threads that share a tick; more than one helps from about a million nodes on"},
       &AnimationConfig::threads},
      {{.name = "resume",
        .default_value = true,
        .help = "a daemon that is started again goes on with the motion with which it ended, for 10 minutes; false: it "
                "begins at rest"},
       &AnimationConfig::resumes},
  };
  return kFields;
}

/// The table whose fields make a member of the configuration, and nothing else.
template <auto kFields, auto kMember>
std::vector<ParameterError> fill(Config& config, const ParameterValues& values) {
  config.*kMember = {};
  return kFields().fill(config.*kMember, values.all());
}

std::vector<ParameterError> fill_look(Config& config, const ParameterValues& values) {
  const auto look = look::look_of(values);
  if (!look) return {look.error()};
  config.look = *look;
  return {};
}

}  // namespace

std::span<const ConfigTable> config_tables() {
  using enum KeyChange;
  static const std::array kTables = {
      ConfigTable{.name = "",
                  .summary = "at the top of the file",
                  .parameters = general_fields().parameters(),
                  .change = kTakesRestart,
                  .fill = [](Config& config,
                             const ParameterValues& values) { return general_fields().fill(config, values.all()); }},
      ConfigTable{.name = "stream",
                  .summary = "where viewers connect",
                  .parameters = stream_fields().parameters(),
                  .change = kAtOnce,
                  .fill = fill<stream_fields, &Config::stream>},
      ConfigTable{.name = "http",
                  .summary = "state and control by HTTP",
                  .parameters = http_fields().parameters(),
                  .change = kTakesRestart,
                  .fill = [](Config& config, const ParameterValues& values) { return fill_http(config.http, values); }},
      ConfigTable{.name = "recording",
                  .summary = "what is recorded, and how much of it is kept",
                  .parameters = recording_fields().parameters(),
                  .change = kAtOnce,
                  .fill = fill<recording_fields, &Config::recording>},
      ConfigTable{.name = "animation",
                  .summary = "the pace",
                  .parameters = animation_fields().parameters(),
                  .change = kTakesRestart,
                  .fill = fill<animation_fields, &Config::animation>},
      ConfigTable{.name = "wind",
                  .summary = "the wind without a live sensor, and the transition from one wind to another",
                  .parameters = wind_parameters(),
                  .change = kTakesRestart,
                  .fill = [](Config& config, const ParameterValues& values) { return fill_wind(config.wind, values); }},
      ConfigTable{
          .name = "shaping",
          .summary = "days without wind, storms, opening hours: from the real wind to the scenes'",
          .parameters = shaping_parameters(),
          .change = kAtOnce,
          .fill = [](Config& config,
                     const ParameterValues& values) { return fill_shaping(config.shaping, values, config.wind); }},
      ConfigTable{.name = "look",
                  .summary = "light and weather of the picture; viewers follow it at once",
                  .parameters = look::look_parameters(),
                  .change = kAtOnce,
                  .fill = fill_look},
      ConfigTable{.name = "mqtt",
                  .summary = "publishes the wind on an MQTT broker, also for Home Assistant",
                  .parameters = feeds::mqtt_fields().parameters(),
                  .change = kAtOnce,
                  .fill = [](Config& config,
                             const ParameterValues& values) { return feeds::fill_mqtt(config.feeds.mqtt, values); }},
      ConfigTable{
          .name = "osc_query",
          .summary = "lets programs find out which OSC addresses there are, and listen to them",
          .parameters = feeds::osc_query_fields().parameters(),
          .change = kAtOnce,
          .fill = [](Config& config,
                     const ParameterValues& values) { return feeds::fill_osc_query(config.feeds.osc_query, values); }},
      ConfigTable{.name = "log",
                  .summary = "what the daemon writes to standard error",
                  .parameters = log_fields().parameters(),
                  .change = kAtOnce,
                  .fill = fill<log_fields, &Config::log>},
  };
  return kTables;
}

const ConfigTable& config_table(std::string_view name) {
  const auto found = std::ranges::find(config_tables(), name, &ConfigTable::name);
  if (found == config_tables().end()) throw std::logic_error("no table [" + std::string(name) + "]");
  return *found;
}

std::span<const std::string_view> config_lists() {
  static const std::vector<std::string_view> kLists = [] {
    std::vector<std::string_view> lists = {"sensor", "scene", "camera", "alert", "output"};
    for (const feeds::ListTable& list : feeds::list_tables()) lists.push_back(list.name);
    return lists;
  }();
  return kLists;
}

}  // namespace yuragi::daemon::settings
