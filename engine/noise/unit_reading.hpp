#pragma once

#include "engine/noise/noise_tile.hpp"

namespace yuragi::noise {

/// Scales a noise so that reading it between samples gives variance 1. Interpolated values, over all places, have 2/3
/// of a sample's variance plus 1/3 of its covariance with the next one, on each axis: bands with few samples per wave
/// lose much of their variance. The tile is_readable() and not constant. Set-up work. Thread-safe: no.
void scale_to_unit_reading(Tile1& tile);
void scale_to_unit_reading(Tile2& tile);

}  // namespace yuragi::noise
