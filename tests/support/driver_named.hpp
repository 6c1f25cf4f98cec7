#pragma once

#include <stdexcept>
#include <string>

#include "drivers/sensor/driver.hpp"

namespace yuragi {

/// The driver of that name, as the daemon finds it.
inline const drivers::sensor::DriverDescription& driver_named(std::string_view name) {
  if (const auto* const driver = drivers::sensor::find_driver(name)) return *driver;
  throw std::logic_error("no driver named " + std::string(name));
}

/// What the driver makes of a configuration. Throws what it throws.
inline ParameterValues values_for(std::string_view driver, const ParameterValues::Map& given) {
  return *ParameterValues::resolve(driver_named(driver).parameters, given);
}

}  // namespace yuragi
