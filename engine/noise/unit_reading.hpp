#pragma once

#include "engine/noise/noise_tile.hpp"

namespace yuragi::noise {

/// Gives a noise variance 1 as it is read. Reading between samples, over all places alike, has 2/3 of a sample's own
/// variance, and 1/3 of what it has in common with the next one, on each axis: bands whose waves have few samples lose
/// much of theirs. The tile is_readable() and not constant. Set-up work. Thread-safe: no.
void scale_to_unit_reading(Tile1& tile);
void scale_to_unit_reading(Tile2& tile);

}  // namespace yuragi::noise
