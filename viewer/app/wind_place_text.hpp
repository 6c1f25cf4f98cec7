#pragma once

#include <string>

#include "engine/wire/wire.hpp"

namespace yuragi::viewer::app {

/// Where the wind that the overlay shows is measured: "at the edge, 0.7 s to the middle", "at the sensors, 12 m
/// downwind". Empty if it is in the middle.
std::string wind_place_text(const wind::State& wind);

}  // namespace yuragi::viewer::app
