#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "drivers/sensor/found_device.hpp"
#include "drivers/sensor/sensor.hpp"
#include "engine/base/parameter.hpp"

namespace yuragi::drivers::sensor {

/// A family of sensors: one constant `kXDriver` in its own file, listed in drivers/CMakeLists.txt.
struct DriverDescription {
  std::string_view name;
  std::string_view summary;
  std::span<const Parameter> parameters;
  /// Constructs a sensor from resolved values, without touching the device: poll() does that. Throws
  /// std::runtime_error, saying what to do, where the values contradict each other or name a missing file.
  std::unique_ptr<Sensor> (*open)(const ParameterValues& values);
  /// Finds plugged-in devices that this driver can read; nullptr where nothing can be plugged in. Opens devices only
  /// briefly.
  std::vector<FoundDevice> (*find)() = nullptr;
  /// It plays a recording: never to be taken for the live wind.
  bool plays_recordings = false;
  /// A relative sensor: only the fluctuations of its readings are valid, not their scale, which depends on where it
  /// is mounted. It is compared with no other sensor, and beside others only its gusts count, unless configured
  /// otherwise.
  bool is_relative = false;
};

/// Every driver (generated).
std::span<const DriverDescription* const> driver_table();

}  // namespace yuragi::drivers::sensor
