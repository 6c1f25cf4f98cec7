#include "engine/pose/pose_arrays.hpp"

#include <algorithm>

namespace yuragi::pose {
namespace {

StrandPose rest_pose_of(const StrandSkeleton& strands) {
  return {std::vector<float>(strands.padded_count()), std::vector<float>(strands.padded_count())};
}

GridPose rest_pose_of(const GridSkeleton& grid) {
  const std::vector<float> zeros(grid.rows * grid.stride());
  return {zeros, zeros, zeros};
}

TreePose rest_pose_of(const TreeSkeleton& tree) {
  TreePose pose;
  for (const TreeLevel& level : tree.levels) pose.levels.push_back(rest_pose_of(level.strands));
  return pose;
}

SurfacePose rest_pose_of(const SurfaceSkeleton& surface) {
  const std::size_t count = surface.columns * surface.rows;
  const std::vector<float> rows(surface.moves_rows() ? surface.rows : 0);
  return {std::vector<float>(count),
          std::vector<float>(surface.ramp_rgba.empty() ? 0 : count),
          rows,
          rows,
          rows,
          rows,
          rows};
}

bool is_pose_of(const StrandPose& pose, const StrandSkeleton& strands) noexcept {
  return pose.bend_east_rad.size() == strands.padded_count() && pose.bend_south_rad.size() == strands.padded_count();
}

bool is_pose_of(const GridPose& pose, const GridSkeleton& grid) noexcept {
  const std::size_t count = grid.rows * grid.stride();
  return pose.offset_x_m.size() == count && pose.offset_y_m.size() == count && pose.offset_z_m.size() == count;
}

bool is_pose_of(const TreePose& pose, const TreeSkeleton& tree) noexcept {
  return std::equal(pose.levels.begin(), pose.levels.end(), tree.levels.begin(), tree.levels.end(),
                    [](const StrandPose& level, const TreeLevel& model) { return is_pose_of(level, model.strands); });
}

bool is_pose_of(const SurfacePose& pose, const SurfaceSkeleton& surface) noexcept {
  const std::size_t count = surface.columns * surface.rows;
  const std::size_t rows = surface.moves_rows() ? surface.rows : 0;
  return pose.displacement_m.size() == count && pose.heat.size() == (surface.ramp_rgba.empty() ? 0 : count) &&
         pose.row_east_m.size() == rows && pose.row_south_m.size() == rows && pose.row_drop_m.size() == rows &&
         pose.row_slope_east.size() == rows && pose.row_slope_south.size() == rows;
}

std::size_t node_count_of(const StrandSkeleton& strands) noexcept {
  return strands.strand_count * strands.links_per_strand;
}

std::size_t node_count_of(const GridSkeleton& grid) noexcept {
  return grid.columns * grid.rows;
}

std::size_t node_count_of(const TreeSkeleton& tree) noexcept {
  std::size_t count = 0;
  for (const TreeLevel& level : tree.levels) count += node_count_of(level.strands);
  return count;
}

std::size_t node_count_of(const SurfaceSkeleton& surface) noexcept {
  return surface.columns * surface.rows;
}

}  // namespace

Pose rest_pose(const Skeleton& skeleton) {
  return std::visit([](const auto& kind) { return Pose(rest_pose_of(kind)); }, skeleton);
}

bool fits(const Pose& pose, const Skeleton& skeleton) noexcept {
  bool is_pose = false;
  const auto check = [&is_pose](const auto* kind, const auto* model) {
    if (kind != nullptr && model != nullptr) is_pose = is_pose_of(*kind, *model);
  };
  check(std::get_if<StrandPose>(&pose), std::get_if<StrandSkeleton>(&skeleton));
  check(std::get_if<GridPose>(&pose), std::get_if<GridSkeleton>(&skeleton));
  check(std::get_if<TreePose>(&pose), std::get_if<TreeSkeleton>(&skeleton));
  check(std::get_if<SurfacePose>(&pose), std::get_if<SurfaceSkeleton>(&skeleton));
  return is_pose;
}

std::size_t node_count(const Skeleton& skeleton) noexcept {
  std::size_t count = 0;
  const auto add = [&count](const auto* kind) {
    if (kind != nullptr) count = node_count_of(*kind);
  };
  add(std::get_if<StrandSkeleton>(&skeleton));
  add(std::get_if<GridSkeleton>(&skeleton));
  add(std::get_if<TreeSkeleton>(&skeleton));
  add(std::get_if<SurfaceSkeleton>(&skeleton));
  return count;
}

}  // namespace yuragi::pose
