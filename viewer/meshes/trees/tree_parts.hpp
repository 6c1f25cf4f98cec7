#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/pose/skeleton.hpp"

namespace yuragi::viewer::meshes::trees {

/// An instance for a strand of a tree (a branch or a leaf), in the layout that the tree's shaders read.
///
/// A tree's joints are in one array, level after level, each in the layout of JointPositions.
struct Part {
  std::array<float, 3> root_m{};  ///< position at rest
  float base_radius_m = 0.0F;     ///< of a leaf: half its width
  std::array<float, 3> tint{};    ///< linear light
  float tip_radius_m = 0.0F;      ///< of a leaf: its strand's length
  std::array<float, 3> facing{};  ///< of a leaf: the normal of its upper side; of a branch: a direction across it
  std::array<float, 3>
      rest{};  ///< of a leaf: unit vector from foot to tip at rest; of a branch: how far it is drawn aside, metres
  std::uint32_t strand = 0;
  std::int32_t root_at = -1;  ///< index of the x of the joint that it grows from; negative: it stands on the ground
};

/// The index in that array at which the joints of a level begin.
std::size_t first_joint_at(const pose::TreeSkeleton& tree, std::size_t level);

/// The parts of a level, one a strand, leaves in the colours of the tree's foliage, or of another. The same tree always
/// makes the same parts.
std::vector<Part> tree_parts(const pose::TreeSkeleton& tree, std::size_t level);
std::vector<Part> tree_parts(const pose::TreeSkeleton& tree, std::size_t level, pose::FoliageColor foliage);

/// The part of the length of a level's branches, from their feet, on which nothing grows: 0 to 1.
float bare_share(const pose::TreeSkeleton& tree, std::size_t level);

/// The direction of a link of a strand at rest.
glm::vec3 link_at_rest(const pose::StrandSkeleton& strands, std::size_t strand, std::size_t link);

}  // namespace yuragi::viewer::meshes::trees
