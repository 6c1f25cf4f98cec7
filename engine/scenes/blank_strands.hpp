#pragma once

#include <cstddef>

#include "engine/pose/skeleton.hpp"

namespace yuragi::scenes {

/// All arrays of strands at their padded size, for laying out a model: each stands upright at the origin and has length
/// 0, and the padding stays so. Allocates.
pose::StrandSkeleton blank_strands(std::size_t strands, std::size_t links);

}  // namespace yuragi::scenes
