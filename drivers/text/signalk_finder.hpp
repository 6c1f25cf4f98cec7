#pragma once

#include <vector>

#include "drivers/sensor/found_device.hpp"
#include "drivers/sensor/network_search.hpp"

namespace yuragi::drivers::text {

/// The Signal K servers that answer by multicast DNS within the search's time. Throws FailureError if nobody can be
/// asked.
std::vector<sensor::FoundDevice> find_signalk_servers(const sensor::NetworkSearch& search);

}  // namespace yuragi::drivers::text
