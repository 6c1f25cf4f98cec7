#pragma once

#include <cstddef>

#include "engine/pose/skeleton.hpp"

namespace yuragi::scenes {

/// All arrays of strands at their padded size, for a model to be laid out in: each stands upright at the origin and has
/// no length, and what is behind the last stays so. Allocates.
pose::StrandSkeleton blank_strands(std::size_t strands, std::size_t links);

}  // namespace yuragi::scenes
