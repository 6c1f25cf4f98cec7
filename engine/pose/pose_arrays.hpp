#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <type_traits>

#include "engine/pose/skeleton.hpp"

namespace yuragi::pose {

/// A pose of any kind, or one of the kinds.
template <class T>
concept PoseLike = std::is_same_v<T, Pose> || std::is_same_v<T, StrandPose> || std::is_same_v<T, GridPose> ||
    std::is_same_v<T, TreePose> || std::is_same_v<T, SurfacePose>;

/// Calls `visit(std::span<float>)` (or of const float) for each array of a pose, always in the same order: code that
/// blends, hashes or counts poses need not distinguish their kinds. Allocates nothing. Thread-safe and realtime-safe as
/// `visit` is.
template <class AnyPose, class Visit>
requires PoseLike<std::remove_const_t<AnyPose>>
void for_each_array(AnyPose& pose, Visit&& visit) {
  using Kind = std::remove_const_t<AnyPose>;
  if constexpr (std::is_same_v<Kind, Pose>) {
    // Unlike std::visit, this throws nothing: it serves functions that are noexcept.
    if (auto* strands = std::get_if<StrandPose>(&pose)) for_each_array(*strands, visit);
    if (auto* grid = std::get_if<GridPose>(&pose)) for_each_array(*grid, visit);
    if (auto* tree = std::get_if<TreePose>(&pose)) for_each_array(*tree, visit);
    if (auto* surface = std::get_if<SurfacePose>(&pose)) for_each_array(*surface, visit);
  } else if constexpr (std::is_same_v<Kind, StrandPose>) {
    visit(std::span(pose.bend_east_rad));
    visit(std::span(pose.bend_south_rad));
  } else if constexpr (std::is_same_v<Kind, GridPose>) {
    visit(std::span(pose.offset_x_m));
    visit(std::span(pose.offset_y_m));
    visit(std::span(pose.offset_z_m));
  } else if constexpr (std::is_same_v<Kind, TreePose>) {
    for (auto& level : pose.levels) for_each_array(level, visit);
  } else {
    visit(std::span(pose.displacement_m));
    visit(std::span(pose.heat));
    visit(std::span(pose.row_east_m));
    visit(std::span(pose.row_south_m));
    visit(std::span(pose.row_drop_m));
    visit(std::span(pose.row_slope_east));
    visit(std::span(pose.row_slope_south));
  }
}

/// The same arrays, in a list with room for those of a tree.
template <class Float>
class Arrays {
 public:
  template <class AnyPose>
  explicit Arrays(AnyPose& pose) {
    for_each_array(pose, [this](auto array) {
      if (count_ < arrays_.size()) arrays_[count_++] = array;
    });
  }

  auto begin() const noexcept { return arrays_.begin(); }
  auto end() const noexcept { return arrays_.begin() + static_cast<std::ptrdiff_t>(count_); }
  std::size_t size() const noexcept { return count_; }
  std::span<Float> operator[](std::size_t index) const noexcept { return arrays_[index]; }

 private:
  std::array<std::span<Float>, 2 * kMaxTreeLevels> arrays_;
  std::size_t count_ = 0;
};

/// The rest pose of a skeleton: zeros in its layout. Allocates.
Pose rest_pose(const Skeleton& skeleton);

/// Returns true if `pose` is of the skeleton's kind, with arrays of its sizes.
bool fits(const Pose& pose, const Skeleton& skeleton) noexcept;

/// How many joints of a skeleton move: the paper's N. Padding does not count.
std::size_t node_count(const Skeleton& skeleton) noexcept;

}  // namespace yuragi::pose
