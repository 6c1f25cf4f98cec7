#pragma once

#include <span>
#include <string>
#include <vector>

#include "drivers/sensor/driver.hpp"

namespace yuragi::daemon::tools::sensors {

/// A device that is plugged in, and one driver that could read it.
struct DeviceFinding {
  const drivers::sensor::DriverDescription* driver = nullptr;
  drivers::sensor::FoundDevice device;
};

/// Searches for devices with every driver that can, in the order of the table. A search that fails is a finding with
/// that trouble.
std::vector<DeviceFinding> find_devices(std::span<const drivers::sensor::DriverDescription* const> drivers);

/// Searches the local networks with every driver that can, all at the same time; otherwise as find_devices().
std::vector<DeviceFinding> find_devices_in_network(std::span<const drivers::sensor::DriverDescription* const> drivers,
                                                   const drivers::sensor::NetworkSearch& search);

/// The findings, for a person: each device with the TOML to paste into a configuration, and, if it cannot be opened,
/// why and what to do; or that nothing was found. `drivers` are those that were searched with.
std::string device_list(std::span<const DeviceFinding> findings,
                        std::span<const drivers::sensor::DriverDescription* const> drivers);

}  // namespace yuragi::daemon::tools::sensors
