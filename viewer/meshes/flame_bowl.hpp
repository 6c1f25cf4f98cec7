#pragma once

#include <glm/vec3.hpp>

#include "engine/pose/skeleton.hpp"
#include "viewer/meshes/solid_mesh.hpp"

namespace yuragi::viewer::meshes {

/// A fire bowl of iron on three legs, with logs in it, on a ring of stones: under a flame's foot. Where the foot is on
/// the ground the legs are short, and the flame begins in the bowl.
struct FlameBowl {
  SolidMesh mesh;
  glm::vec3 embers_m{0.0F};  ///< the middle of their bed, a level disc
  float embers_radius_m = 0.0F;
};

/// Empty if the surface is. Pure.
FlameBowl flame_bowl(const pose::SurfaceSkeleton& surface);

}  // namespace yuragi::viewer::meshes
