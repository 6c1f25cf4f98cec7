#include "daemon/settings/same_device.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "daemon/settings/config_error.hpp"

namespace yuragi::daemon::settings {
namespace {

using drivers::sensor::Endpoint;
using drivers::sensor::ValueSelection;

/// What one sensor needs of its device; empty if that is not known: open_sensor() reports the reason, unless
/// the sensor has been running since before its profile was lost.
struct DeviceUse {
  const SensorConfig* sensor;
  std::optional<ValueSelection> selection;
  std::vector<Endpoint> endpoints;
};

DeviceUse use_of(const SensorConfig& sensor) {
  const drivers::sensor::DriverDescription& driver = *sensor.driver;
  DeviceUse use = {.sensor = &sensor, .selection = {}, .endpoints = {}};
  try {
    if (driver.selection != nullptr) use.selection = driver.selection(sensor.values);
    if (driver.endpoints != nullptr) use.endpoints = driver.endpoints(sensor.values);
  } catch (const std::runtime_error&) {
    return {.sensor = &sensor, .selection = {}, .endpoints = {}};
  }
  return use;
}

ConfigError same_device(const DeviceUse& first, const DeviceUse& second, const std::string& what) {
  return ConfigError(fmt::format("{}: sensors \"{}\" and \"{}\" both {}", place_of(*second.sensor), first.sensor->name,
                                 second.sensor->name, what));
}

/// "(transmitter: any and 1)"; empty if no part selects anything.
std::string parts_text(const ValueSelection& first, const ValueSelection& second) {
  std::string text;
  for (std::size_t i = 0; i < first.parts.size(); ++i) {
    const std::string& one = first.parts[i].value;
    const std::string& other = second.parts[i].value;
    if (one.empty() && other.empty()) continue;
    const auto shown = [](const std::string& value) { return value.empty() ? std::string("any") : value; };
    text += fmt::format("{}{}: {}{}", text.empty() ? " (" : "; ", first.parts[i].key, shown(one),
                        one == other ? "" : " and " + shown(other));
  }
  return text.empty() ? text : text + ")";
}

void refuse_same_values(const DeviceUse& first, const DeviceUse& second) {
  if (first.sensor->driver != second.sensor->driver || !first.selection) return;
  const ValueSelection& one = *first.selection;
  const ValueSelection& other = *second.selection;
  if (!covers(one, other) && !covers(other, one)) return;
  std::string keys(one.device_keys);
  for (const auto& part : one.parts) keys += fmt::format("{}{}", keys.empty() ? "" : ", ", part.key);
  throw same_device(first, second,
                    fmt::format("read {}{}: remove one of the sensors, or give them different settings (one of: {})",
                                one.device, parts_text(one, other), keys));
}

void refuse_same_claim(const DeviceUse& first, const DeviceUse& second) {
  const bool is_one_driver = first.sensor->driver == second.sensor->driver;
  for (const Endpoint& endpoint : second.endpoints) {
    const auto other = std::ranges::find(first.endpoints, endpoint.claim, &Endpoint::claim);
    if (endpoint.claim.empty() || other == first.endpoints.end()) continue;
    if (is_one_driver && endpoint.is_shared && other->is_shared) continue;
    throw same_device(
        first, second,
        fmt::format("need {}, which only one sensor can use: remove one of them, or give one of them another",
                    endpoint.claim));
  }
}

}  // namespace

void refuse_same_device(std::span<const SensorConfig> sensors) {
  std::vector<DeviceUse> uses;
  for (const SensorConfig& sensor : sensors) {
    if (sensor.stand_in) continue;
    DeviceUse& second = uses.emplace_back(use_of(sensor));
    for (const DeviceUse& first : std::span(uses).first(uses.size() - 1)) {
      refuse_same_values(first, second);
      refuse_same_claim(first, second);
    }
  }
}

}  // namespace yuragi::daemon::settings
