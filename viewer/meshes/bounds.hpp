#pragma once

#include <glm/vec3.hpp>

#include "engine/pose/skeleton.hpp"

namespace yuragi::viewer::meshes {

/// A box around something, in metres.
struct Bounds {
  glm::vec3 low_m{0.0F};
  glm::vec3 high_m{0.0F};
};

/// The box that a skeleton's poses fill. An estimate: in a storm a cloth may exceed it.
Bounds bounds_of(const pose::Skeleton& skeleton);
Bounds bounds_of(const pose::StrandSkeleton& strands);
Bounds bounds_of(const pose::GridSkeleton& cloth);
Bounds bounds_of(const pose::TreeSkeleton& tree);
Bounds bounds_of(const pose::SurfaceSkeleton& surface);

/// The box around both.
Bounds united(const Bounds& a, const Bounds& b);

}  // namespace yuragi::viewer::meshes
