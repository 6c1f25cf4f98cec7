#pragma once

#include <vector>

#include "drivers/sensor/found_device.hpp"
#include "drivers/sensor/network_search.hpp"

namespace yuragi::drivers::network {

/// The gateways that answer within the search's time. Throws FailureError if nobody can be asked.
std::vector<sensor::FoundDevice> find_ecowitt_gateways(const sensor::NetworkSearch& search);

}  // namespace yuragi::drivers::network
