#include "daemon/tools/sensors/description_json.hpp"

#include <array>
#include <cmath>

#include <nlohmann/json.hpp>

namespace yuragi::daemon::tools::sensors {
namespace {

using nlohmann::ordered_json;

ordered_json finite_or_null(double number) {
  return std::isfinite(number) ? ordered_json(number) : ordered_json(nullptr);
}

ordered_json text_or_null(std::string_view text) {
  return text.empty() ? ordered_json(nullptr) : ordered_json(text);
}

/// Its value in a configuration; null if leaving it out has a meaning of its own.
ordered_json default_of(const Parameter& parameter) {
  if (!parameter.left_out.empty()) return nullptr;
  return std::visit([](const auto& value) { return ordered_json(value); }, printable(parameter.default_value));
}

std::string_view type_of(const Parameter& parameter) {
  constexpr std::array<std::string_view, 5> kNames = {"boolean", "integer", "number", "text", "secret"};
  static_assert(std::variant_size_v<ParameterValue> == kNames.size());
  return kNames.at(parameter.default_value.index());
}

/// Null if unknown.
ordered_json value_json(const std::optional<drivers::sensor::StatedValue>& stated) {
  if (!stated || stated->value == wind::ReadingValue::kUnknown) return nullptr;
  return {{"value", wind::kReadingValueNames.at(static_cast<std::size_t>(stated->value))},
          {"averaging_s", stated->averaging_s > 0.0 ? ordered_json(stated->averaging_s) : ordered_json(nullptr)},
          {"source", stated->source}};
}

ordered_json known_devices_json(const drivers::sensor::DriverDescription& driver) {
  ordered_json all = ordered_json::array();
  if (driver.known_devices == nullptr) return all;
  for (const drivers::sensor::KnownDevice& device : driver.known_devices()) {
    all.push_back({{"name", device.name},
                   {"device", device.device},
                   {"confirmed_by", device.confirmed_by},
                   {"unconfirmed", text_or_null(device.unconfirmed)},
                   {"value", value_json(device.value)}});
  }
  return all;
}

}  // namespace

ordered_json parameters_json(std::span<const Parameter> parameters) {
  ordered_json all = ordered_json::array();
  for (const Parameter& parameter : parameters) {
    ordered_json choices = nullptr;
    if (!parameter.choices.empty())
      choices = std::vector<std::string>(parameter.choices.begin(), parameter.choices.end());
    all.push_back({{"name", parameter.name},
                   {"type", type_of(parameter)},
                   {"unit", text_or_null(parameter.unit)},
                   {"default", default_of(parameter)},
                   {"left_out", text_or_null(parameter.left_out)},
                   {"min", finite_or_null(parameter.min)},
                   {"max", finite_or_null(parameter.max)},
                   {"choices", choices},
                   {"help", parameter.help}});
  }
  return all;
}

ordered_json drivers_json(std::span<const drivers::sensor::DriverDescription* const> drivers) {
  ordered_json all = ordered_json::array();
  for (const drivers::sensor::DriverDescription* driver : drivers) {
    all.push_back({{"name", driver->name},
                   {"summary", driver->summary},
                   {"parameters", parameters_json(driver->parameters)},
                   {"known_devices", known_devices_json(*driver)},
                   {"device_setup", text_or_null(driver->device_setup)}});
  }
  return all;
}

ordered_json devices_json(std::span<const DeviceFinding> findings) {
  ordered_json all = ordered_json::array();
  for (const DeviceFinding& finding : findings) {
    all.push_back({{"driver", finding.driver->name},
                   {"device", finding.device.what},
                   {"settings", text_or_null(finding.device.settings)},
                   {"trouble", text_or_null(finding.device.trouble)},
                   {"remedy", text_or_null(finding.device.remedy)}});
  }
  return all;
}

}  // namespace yuragi::daemon::tools::sensors
