#pragma once

#include <string>
#include <utility>
#include <vector>

namespace yuragi::drivers::sensor {

/// A device that only one sensor can use at a time.
struct DeviceClaim {
  std::string device;      ///< its identity, for people, too: "serial port /dev/ttyUSB0"
  bool is_shared = false;  ///< the driver's own sensors share it with one another
};

/// The claim of one device, or none where its identity is empty.
inline std::vector<DeviceClaim> claims_of(std::string device) {
  if (device.empty()) return {};
  return {{std::move(device)}};
}

}  // namespace yuragi::drivers::sensor
