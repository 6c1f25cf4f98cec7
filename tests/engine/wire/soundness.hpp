#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/pose/pose_arrays.hpp"
#include "engine/wire/wire.hpp"

// What decode() promises of every skeleton and pose that it lets through, for the tests with hostile bytes and the
// fuzzer.

namespace yuragi::samples {

inline bool are_numbers(const std::vector<float>& values, std::size_t count) {
  return values.size() == count &&
         std::all_of(values.begin(), values.end(), [](float value) { return std::abs(value) <= 1e6f; });
}

inline bool is_sound(const pose::StrandSkeleton& s) {
  if (s.links_per_strand < 1 || s.links_per_strand > wire::kMaxLinksPerStrand) return false;
  if (s.strand_count > wire::kMaxStrands) return false;
  const auto arrays = {&s.root_x_m, &s.root_y_m, &s.root_z_m, &s.rest_x,        &s.rest_y,       &s.rest_z,
                       &s.curl_x,   &s.curl_y,   &s.curl_z,   &s.rest_curl_rad, &s.link_length_m};
  return std::all_of(arrays.begin(), arrays.end(),
                     [&s](const auto* values) { return are_numbers(*values, s.padded_count()); }) &&
         std::all_of(s.link_length_m.begin(), s.link_length_m.end(), [](float length_m) { return length_m >= 0.0f; });
}

inline bool is_sound(const pose::GridSkeleton& s) {
  const std::size_t count = s.rows * s.stride();
  return count <= wire::kMaxStrands && are_numbers(s.rest_x_m, count) && are_numbers(s.rest_y_m, count) &&
         are_numbers(s.rest_z_m, count);
}

inline bool is_sound(const pose::TreeSkeleton& tree) {
  if (tree.levels.empty() || tree.levels.size() > pose::kMaxTreeLevels) return false;
  for (std::size_t i = 0; i < tree.levels.size(); ++i) {
    const pose::TreeLevel& level = tree.levels[i];
    const std::size_t count = level.strands.padded_count();
    if (!is_sound(level.strands) || !are_numbers(level.base_radius_m, count) || !are_numbers(level.tip_radius_m, count))
      return false;
    if (level.parent.size() != (i > 0 ? count : 0) || level.parent_link.size() != level.parent.size()) return false;
    for (std::size_t k = 0; k < level.parent.size(); ++k) {
      if (level.parent_level >= i) return false;
      const pose::StrandSkeleton& parents = tree.levels[level.parent_level].strands;
      if (level.parent[k] >= parents.strand_count || level.parent_link[k] >= parents.links_per_strand) return false;
    }
  }
  return true;
}

inline bool is_sound(const pose::SurfaceSkeleton& s) {
  const std::size_t count = s.columns * s.rows;
  if (s.shells < 1 || s.columns % s.shells != 0) return false;
  const std::size_t axis = s.moves_rows() ? s.rows : 0;
  if (!are_numbers(s.axis_x_m, axis) || !are_numbers(s.axis_z_m, axis)) return false;
  return count <= wire::kMaxStrands && are_numbers(s.rest_x_m, count) && are_numbers(s.rest_y_m, count) &&
         are_numbers(s.rest_z_m, count) && are_numbers(s.normal_x, count) && are_numbers(s.normal_y, count) &&
         are_numbers(s.normal_z, count) && (s.ramp_rgba.empty() || s.ramp_rgba.size() == 1024);
}

inline bool is_sound(const pose::Skeleton& skeleton) {
  // A kind that is not known comes as strands without any arrays.
  const auto* strands = std::get_if<pose::StrandSkeleton>(&skeleton);
  if (strands != nullptr && strands->strand_count == 0) return strands->links_per_strand >= 1;
  return std::visit([](const auto& kind) { return is_sound(kind); }, skeleton);
}

inline bool is_sound(const pose::Pose& pose) {
  bool is_finite = true;
  pose::for_each_array(pose, [&is_finite](std::span<const float> values) {
    for (const float value : values) is_finite = is_finite && std::abs(value) <= 1e6f;
  });
  if (!is_finite) return false;
  if (const auto* grid = std::get_if<pose::GridPose>(&pose))
    return grid->offset_x_m.size() == grid->offset_y_m.size() && grid->offset_x_m.size() == grid->offset_z_m.size();
  if (const auto* surface = std::get_if<pose::SurfacePose>(&pose))
    return (surface->heat.empty() || surface->heat.size() == surface->displacement_m.size()) &&
           surface->row_south_m.size() == surface->row_east_m.size() &&
           surface->row_drop_m.size() == surface->row_east_m.size() &&
           surface->row_slope_east.size() == surface->row_east_m.size() &&
           surface->row_slope_south.size() == surface->row_east_m.size();
  const pose::Arrays<const float> arrays(pose);  // of strands and trees: pairs of one length
  for (std::size_t i = 0; i + 1 < arrays.size(); i += 2) {
    if (arrays[i].size() != arrays[i + 1].size()) return false;
  }
  return true;
}

}  // namespace yuragi::samples
