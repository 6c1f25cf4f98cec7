#include "daemon/settings/recorded_sensor.hpp"

#include "daemon/settings/config.hpp"
#include "drivers/sensor/driver.hpp"

namespace yuragi::daemon::settings {

RecordedSource recorded_source(std::string_view driver, std::string_view options) {
  const drivers::sensor::DriverDescription* const found = drivers::sensor::find_driver(driver);
  if (found == nullptr) return {};
  const auto values = parse_values(options, found->parameters);
  if (!values) return {};
  return {.unchanged_for_s = found->unchanged_for_s == nullptr ? 0.0 : found->unchanged_for_s(*values),
          .value = found->stated_value == nullptr ? std::nullopt : found->stated_value(*values)};
}

}  // namespace yuragi::daemon::settings
