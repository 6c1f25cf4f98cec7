#pragma once

#include <span>

#include <nlohmann/json_fwd.hpp>

#include "daemon/tools/sensors/device_list.hpp"
#include "drivers/sensor/driver.hpp"
#include "engine/base/parameter.hpp"

namespace yuragi::daemon::tools::sensors {

// What device_list.hpp and driver_reference.hpp print, as JSON.

/// Each parameter: name, unit, type, default, least and most (null if there is none), choices, help.
nlohmann::ordered_json parameters_json(std::span<const Parameter> parameters);

/// Each driver: name, summary, parameters, and the devices that it knows by name: name, device, confirmed_by,
/// unconfirmed (null if that is nothing); device_setup (null if nothing is set at the device).
nlohmann::ordered_json drivers_json(std::span<const drivers::sensor::DriverDescription* const> drivers);

/// Each finding: driver, device, the lines to paste (TOML), trouble and remedy (null if it can be opened).
nlohmann::ordered_json devices_json(std::span<const DeviceFinding> findings);

}  // namespace yuragi::daemon::tools::sensors
