#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "drivers/bus/byte_port.hpp"

namespace yuragi::drivers::sensor {

/// A setting that selects from a device's messages.
struct SelectedPart {
  std::string_view key;  ///< the setting's name
  std::string value;     ///< empty: any
  /// Returns true if `wide` takes everything that another text, `narrow`, takes; nullptr: each value excludes all
  /// others.
  bool (*covers)(const std::string& wide, const std::string& narrow) = nullptr;
};

/// The selection of the values that a sensor reads. Two sensors of one driver that read the same values would count one
/// wind twice.
struct ValueSelection {
  std::string device;                    ///< its identity, for people, too: "gateway 192.168.1.30:45000"
  std::string_view device_keys = {};     ///< the settings that select it: "host, port"; empty: `parts` do
  std::vector<SelectedPart> parts = {};  ///< a driver gives the same keys in the same order for all its sensors
};

/// Returns true if a sensor with `wide` may read all that one of the same driver with `narrow` reads. Thread-safe: yes.
bool covers(const ValueSelection& wide, const ValueSelection& narrow);

/// The selection of values from a port (bus::device_of()).
ValueSelection selection_at(const bus::BytePortAddress& address, std::vector<SelectedPart> parts = {});

/// SelectedPart::covers of lists that are separated by commas.
bool list_covers(const std::string& wide, const std::string& narrow);

}  // namespace yuragi::drivers::sensor
