#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "engine/base/time.hpp"

namespace yuragi::drivers::sensor {

/// How the local networks are searched for stations: listens for those that broadcast, and asks the others.
struct NetworkSearch {
  Nanoseconds duration = std::chrono::seconds(12);  ///< a hub of WeatherFlow sends every 10 s
  /// Ask only this IPv4 address; empty: all that receive broadcasts and multicasts on this machine's interfaces.
  std::string to = {};

  // Where the protocols have them.
  std::uint16_t tempest_port = 50222;
  std::uint16_t ecowitt_port = 46000;
  std::uint16_t dns_port = 5353;
};

}  // namespace yuragi::drivers::sensor
