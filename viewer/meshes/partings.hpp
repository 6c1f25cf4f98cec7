#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/pose/skeleton.hpp"
#include "engine/pose/strand_kinematics.hpp"
#include "viewer/meshes/body.hpp"

namespace yuragi::viewer::meshes {

/// Where a coat parts in a pose: there the tips of neighbouring hairs are farther apart than at rest.
///
/// Allocates when it is made, never afterwards. Thread-safe: no.
class Partings {
 public:
  Partings(const pose::StrandSkeleton& coat, const Body& body);

  /// `joints`: the coat's, in the present pose.
  void move_to(const pose::JointPositions& joints);

  /// The divergence of the tips' movement along the skin, one number per strand: 0 at rest, above 0 where the coat is
  /// open (0.1: the tips are farther apart by a tenth), below 0 where it is compressed.
  std::span<const float> openings() const { return openings_; }

 private:
  /// Two strands on opposite sides of another, and the vector from one root to the other over the square of its length.
  struct Sides {
    std::uint32_t from = 0;
    std::uint32_t to = 0;
    glm::vec3 way_per_m{0.0F};
  };

  std::vector<std::array<Sides, 2>> sides_;  ///< for each strand: along the skin in two directions
  std::vector<glm::vec3> rest_m_, moved_m_;  ///< tips at rest, and their displacements
  std::vector<float> openings_;
};

}  // namespace yuragi::viewer::meshes
