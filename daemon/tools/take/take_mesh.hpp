#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/pose/skeleton.hpp"

namespace yuragi::daemon::tools::take {

/// A corner of a mesh, at rest, that goes with one joint.
struct Vertex {
  std::array<float, 3> place_m{};
  std::uint32_t joint = 0;  ///< index into Mesh::joints
};

struct Joint {
  std::optional<std::size_t> number =
      {};                         ///< of the skeleton's joint (pose::Kinematics::joint()); nullopt: stands still
  std::array<float, 3> rest_m{};  ///< where it is while the vertices are at rest
};

/// A scene as a mesh whose vertices each go with a joint of its skeleton. World metres, as the poses.
struct Mesh {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;  ///< triangles
  std::vector<Joint> joints = {{}};    ///< the first stands still
};

/// A ribbon for each strand, a tube for each branch, a surface for each grid. `every`: only each so-manyth, at least 1,
/// of strands, of a tree's twigs and leaves, and of a grid's rows and columns; blades and leaves are so much wider.
/// Pure.
Mesh take_mesh_of(const pose::Skeleton& skeleton, std::size_t every);

/// About the smallest `every` with which the mesh has at most this many joints; nullopt if there is none.
std::optional<std::size_t> every_within(const pose::Skeleton& skeleton, std::size_t most_joints);

}  // namespace yuragi::daemon::tools::take
