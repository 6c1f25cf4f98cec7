#pragma once

#include <cstddef>
#include <cstdint>

#include "daemon/settings/config.hpp"

namespace yuragi::daemon::animation {

/// The hash of what the motion follows from: scenes, wind, its shaping, the rate, and the first `sensors` of the
/// sensors, but not how they are connected and calibrated.
std::uint64_t motion_made_of(settings::Config config, std::size_t sensors);

}  // namespace yuragi::daemon::animation
