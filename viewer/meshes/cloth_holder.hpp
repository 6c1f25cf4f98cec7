#pragma once

#include <optional>

#include "viewer/meshes/cloth_measure.hpp"
#include "viewer/meshes/floor.hpp"
#include "viewer/meshes/solid_mesh.hpp"

namespace yuragi::viewer::meshes {

/// The mesh of a cloth's holder, on the ground at height 0: a curtain's wooden frame with a rod and rings, a flag's
/// pole with its halyard, a banner's bamboo with an arm and loops.
SolidMesh cloth_holder(ClothStyle style, const pose::GridSkeleton& cloth);

/// The floor under a curtain that hangs near the ground, broad enough for its shadow and for the blown cloth.
std::optional<Floor> cloth_floor(ClothStyle style, const pose::GridSkeleton& cloth);

}  // namespace yuragi::viewer::meshes
