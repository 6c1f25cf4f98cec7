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

/// Where a coat parts in a pose: there the tips of hairs that stand beside each other are farther apart than at rest.
///
/// Allocates when it is made, never afterwards. Thread-safe: no.
class Partings {
 public:
  Partings(const pose::StrandSkeleton& coat, const Body& body);

  /// `joints`: the coat's, in the present pose.
  void move_to(const pose::JointPositions& joints);

  /// One number a strand, the divergence of the tips' movement along the skin: 0 at rest, above 0 where the coat is
  /// open (0.1: the tips are farther apart by a tenth), below 0 where it is pressed together.
  std::span<const float> openings() const { return openings_; }

 private:
  /// Two strands on either side of another, and the way from one root to the other over the square of its length.
  struct Sides {
    std::uint32_t from = 0;
    std::uint32_t to = 0;
    glm::vec3 way_per_m{0.0F};
  };

  std::vector<std::array<Sides, 2>> sides_;  ///< of each strand: along the skin in two directions
  std::vector<glm::vec3> rest_m_, moved_m_;  ///< tips at rest, and how far they are from there
  std::vector<float> openings_;
};

}  // namespace yuragi::viewer::meshes
