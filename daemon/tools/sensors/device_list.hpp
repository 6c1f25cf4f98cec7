#pragma once

#include <span>
#include <string>
#include <vector>

#include "drivers/sensor/driver.hpp"

namespace yuragi {

/// A device that is plugged in, and one driver that could read it.
struct DeviceFinding {
  const DriverDescription* driver = nullptr;
  FoundDevice device;
};

/// Asks every driver that can look what is plugged in, in the order of the table. One that fails to look is a finding
/// with that trouble.
std::vector<DeviceFinding> find_devices(std::span<const DriverDescription* const> drivers);

/// What was found, for a person: each device with the TOML to paste into a configuration, and with what keeps it from
/// being opened and what to do about that. Says so where nothing was found. `drivers` are those that were asked.
std::string device_list(std::span<const DeviceFinding> findings, std::span<const DriverDescription* const> drivers);

}  // namespace yuragi
