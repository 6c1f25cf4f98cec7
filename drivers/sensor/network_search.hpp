#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "engine/base/time.hpp"

namespace yuragi::drivers::sensor {

/// How the local networks are searched for stations: what broadcasts by itself is listened to, all else is asked.
struct NetworkSearch {
  Nanoseconds duration = std::chrono::seconds(12);  ///< a hub of WeatherFlow's speaks every 10 s
  /// Ask this IPv4 address alone; empty: whoever hears broadcasts and multicasts on this machine's interfaces.
  std::string to = {};

  // Where the protocols have them.
  std::uint16_t tempest_port = 50222;
  std::uint16_t ecowitt_port = 46000;
  std::uint16_t dns_port = 5353;
};

}  // namespace yuragi::drivers::sensor
