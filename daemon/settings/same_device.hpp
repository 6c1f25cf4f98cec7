#pragma once

#include <span>

#include "daemon/settings/sensor_config.hpp"

namespace yuragi::daemon::settings {

/// Throws ConfigError if two sensors of one driver read the same values (DriverDescription::selection), or if two need
/// a device that only one can open (DriverDescription::endpoints). The message names both, what they share and what to
/// do. Opens no device. Sensors that play from a recording (SensorConfig::stand_in) share nothing.
void refuse_same_device(std::span<const SensorConfig> sensors);

}  // namespace yuragi::daemon::settings
