#include "daemon/settings/recorded_sensor.hpp"

#include <algorithm>

#include "daemon/settings/config.hpp"
#include "drivers/sensor/driver.hpp"

namespace yuragi::daemon::settings {

namespace {

/// nullptr: there is none of this name.
const drivers::sensor::DriverDescription* driver_named(std::string_view name) {
  const auto drivers = drivers::sensor::driver_table();
  const auto found = std::ranges::find_if(
      drivers, [name](const drivers::sensor::DriverDescription* each) { return each->name == name; });
  return found == drivers.end() ? nullptr : *found;
}

}  // namespace

double recorded_unchanged_for_s(std::string_view driver, std::string_view options) {
  const auto* const found = driver_named(driver);
  if (found == nullptr || found->unchanged_for_s == nullptr) return 0.0;
  const auto values = parse_values(options, found->parameters);
  return values ? found->unchanged_for_s(*values) : 0.0;
}

std::optional<drivers::sensor::StatedValue> recorded_value(std::string_view driver, std::string_view options) {
  const auto* const found = driver_named(driver);
  if (found == nullptr || found->stated_value == nullptr) return std::nullopt;
  const auto values = parse_values(options, found->parameters);
  return values ? found->stated_value(*values) : std::nullopt;
}

}  // namespace yuragi::daemon::settings
