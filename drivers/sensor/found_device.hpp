#pragma once

#include <string>
#include <vector>

namespace yuragi::drivers::sensor {

/// A device that is plugged in and that a driver could read.
struct FoundDevice {
  std::string what;      ///< "Oregon Scientific WMR100 (0fde:ca01)"
  std::string settings;  ///< what to write into its [[sensor]] table, as TOML: `device = "/dev/serial/by-id/..."`
  std::string trouble;   ///< why it cannot be opened as things are; empty: it can
  std::string remedy;    ///< what to do about that: the udev rule to install, the group to join
};

}  // namespace yuragi::drivers::sensor
