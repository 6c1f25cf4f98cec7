#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/pose/tree_kinematics.hpp"
#include "viewer/meshes/trees/tree_parts.hpp"
#include "viewer/meshes/trees/tree_place.hpp"
#include "viewer/meshes/view.hpp"

namespace yuragi::viewer::meshes::trees {

/// Branches that are drawn as tubes with the same numbers of rings and sides.
struct BranchGroup {
  std::size_t rings = 1;  ///< at most one a link
  std::size_t tube = 0;   ///< of Branches::kSides
  std::size_t first = 0;  ///< of Branches::parts()
  std::size_t count = 0;
};

/// All branches of a level of wood, and their selection for a picture: the visible ones, with more rings if they are
/// long in it and more sides if they are thick. Allocates when it is made, never afterwards.
class Branches {
 public:
  static constexpr std::size_t kMinRings = 4;  ///< if there are as many links
  static constexpr std::array<std::size_t, 3> kSides = {3, 6, 14};

  /// `tree` must outlive this.
  Branches(const pose::TreeSkeleton& tree, std::size_t level);

  void move_to(const pose::TreeJoints& joints);

  /// Selects the visible ones of the tree, or of a copy of it, with at least a ring for each `ring_px` pixels of their
  /// length.
  void choose(const View& view, float ring_px, const Place& place = {});
  std::span<const Part> parts() const { return std::span(chosen_).first(chosen_count_); }
  std::span<const BranchGroup> groups() const { return groups_; }

 private:
  static constexpr std::size_t kNotSeen = ~std::size_t{0};

  const pose::TreeSkeleton* tree_;
  std::size_t level_;
  std::vector<Part> parts_;
  std::vector<glm::vec3> middles_m_;
  std::vector<float> lengths_m_;
  std::vector<std::size_t> group_of_;
  std::vector<BranchGroup> groups_;
  std::vector<Part> chosen_;
  std::size_t chosen_count_ = 0;
};

}  // namespace yuragi::viewer::meshes::trees
