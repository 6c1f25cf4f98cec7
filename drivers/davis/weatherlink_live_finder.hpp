#pragma once

#include <vector>

#include "drivers/sensor/found_device.hpp"
#include "drivers/sensor/network_search.hpp"

namespace yuragi::drivers::davis {

/// The WeatherLink Lives that answer by multicast DNS within the search's time. Throws FailureError if nobody can be
/// asked.
std::vector<sensor::FoundDevice> find_weatherlink_lives(const sensor::NetworkSearch& search);

}  // namespace yuragi::drivers::davis
