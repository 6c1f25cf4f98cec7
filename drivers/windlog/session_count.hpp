#pragma once

#include <cstdint>

#include "engine/wind/wind_reading.hpp"

namespace yuragi::drivers::windlog {

/// How many readings of one series a session wrote, and a checksum of them that does not depend on their order. Both
/// wrap around. A session that is closed stores it (format.hpp).
struct SessionCount {
  std::uint64_t readings = 0;
  std::uint64_t checksum = 0;

  bool operator==(const SessionCount&) const = default;

  /// Counts a reading with the times that are stored.
  void add(const wind::Reading& reading) noexcept;
};

}  // namespace yuragi::drivers::windlog
