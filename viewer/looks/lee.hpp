#pragma once

#include "engine/pose/skeleton.hpp"
#include "viewer/meshes/bounds.hpp"

namespace yuragi::viewer::looks {

/// Returns `bounds`, extended toward the lee of a wind from `wind_from_deg` by the distance to which a storm blows
/// cloth and flames: for a curtain two thirds of its length, for a flame half its height. Nothing else is extended,
/// because it bends within its box.
meshes::Bounds with_lee(const meshes::Bounds& bounds, const pose::Skeleton& skeleton, double wind_from_deg);

}  // namespace yuragi::viewer::looks
