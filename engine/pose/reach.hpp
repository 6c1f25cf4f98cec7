#pragma once

#include <span>

#include "engine/pose/skeleton.hpp"

namespace yuragi::pose {

/// The radius of the circle about the middle of the world (x = z = 0) that holds all scenes, along the ground, in
/// metres: to the farthest root of a strand (of a tree: of any of its levels), joint of a cloth or point of a surface,
/// all at rest. 0 if there is none. Strands on a grid are the ground around the scenes and are ignored. Pure; allocates
/// nothing. Its time grows with the number of elements: for set-up.
double scenes_reach_m(std::span<const Skeleton* const> skeletons) noexcept;

}  // namespace yuragi::pose
