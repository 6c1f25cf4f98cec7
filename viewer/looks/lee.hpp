#pragma once

#include "engine/pose/skeleton.hpp"
#include "viewer/meshes/bounds.hpp"

namespace yuragi::viewer::looks {

/// Returns `bounds`, longer toward the lee of a wind from `wind_from_deg` by as far as a storm blows out what hangs and
/// what burns: of a curtain two thirds of its length, of a flame half its height. Of all else nothing, because it bends
/// within its box.
meshes::Bounds with_lee(const meshes::Bounds& bounds, const pose::Skeleton& skeleton, double wind_from_deg);

}  // namespace yuragi::viewer::looks
