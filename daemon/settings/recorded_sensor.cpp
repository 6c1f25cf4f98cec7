#include "daemon/settings/recorded_sensor.hpp"

#include <algorithm>

#include "daemon/settings/config.hpp"
#include "drivers/sensor/driver.hpp"

namespace yuragi::daemon::settings {

double recorded_unchanged_for_s(std::string_view driver, std::string_view options) {
  const auto drivers = drivers::sensor::driver_table();
  const auto found = std::ranges::find_if(
      drivers, [driver](const drivers::sensor::DriverDescription* each) { return each->name == driver; });
  if (found == drivers.end() || (*found)->unchanged_for_s == nullptr) return 0.0;
  const auto values = parse_values(options, (*found)->parameters);
  return values ? (*found)->unchanged_for_s(*values) : 0.0;
}

}  // namespace yuragi::daemon::settings
