#pragma once

#include <vector>

#include "drivers/sensor/found_device.hpp"
#include "drivers/sensor/network_search.hpp"

namespace yuragi::drivers::network {

/// Returns the stations with a wind whose hubs are received within the search's time; a hub without one with a trouble.
/// Sends nothing. Throws FailureError if it cannot listen.
std::vector<sensor::FoundDevice> find_tempest_stations(const sensor::NetworkSearch& search);

}  // namespace yuragi::drivers::network
