#pragma once

#include <vector>

#include "drivers/sensor/found_device.hpp"
#include "drivers/sensor/network_search.hpp"

namespace yuragi::drivers::network {

/// The stations with a wind whose hubs are heard within the search's time; and a hub without one, as a trouble. Nothing
/// is sent. Throws FailureError where it cannot listen.
std::vector<sensor::FoundDevice> find_tempest_stations(const sensor::NetworkSearch& search);

}  // namespace yuragi::drivers::network
