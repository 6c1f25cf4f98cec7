#pragma once

#include <span>
#include <string>

#include "drivers/sensor/driver.hpp"

namespace yuragi::daemon::tools::sensors {

// Pages about drivers, generated from their descriptions.

/// Each parameter with its help, unit, range and default, for a terminal.
std::string parameter_text(std::span<const Parameter> parameters);

/// A line for each driver: name and summary.
std::string driver_names(std::span<const drivers::sensor::DriverDescription* const> drivers);

/// The reference of one driver with all parameters and the devices that it knows by name, for a terminal.
std::string describe_driver(const drivers::sensor::DriverDescription& driver);

/// All drivers on one page, in Markdown.
std::string driver_reference(std::span<const drivers::sensor::DriverDescription* const> drivers);

}  // namespace yuragi::daemon::tools::sensors
