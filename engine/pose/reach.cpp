#include "engine/pose/reach.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/math/portable.hpp"

namespace yuragi::pose {
namespace {

/// For `count` places from number `first` on.
double reach_of(const std::vector<float>& x_m, const std::vector<float>& z_m, std::size_t first, std::size_t count) {
  double farthest_m = 0.0;
  for (std::size_t i = first; i < first + count; ++i) {
    farthest_m = std::max(farthest_m, math::length(static_cast<double>(x_m[i]), static_cast<double>(z_m[i])));
  }
  return farthest_m;
}

double reach_of(const StrandSkeleton& strands) {
  if (strands.columns > 0) return 0.0;
  return reach_of(strands.root_x_m, strands.root_z_m, 0, strands.strand_count);
}

double reach_of(const GridSkeleton& grid) {
  double farthest_m = 0.0;
  for (std::size_t row = 0; row < grid.rows; ++row) {
    farthest_m = std::max(farthest_m, reach_of(grid.rest_x_m, grid.rest_z_m, row * grid.stride(), grid.columns));
  }
  return farthest_m;
}

double reach_of(const TreeSkeleton& tree) {
  double farthest_m = 0.0;
  for (const TreeLevel& level : tree.levels) farthest_m = std::max(farthest_m, reach_of(level.strands));
  return farthest_m;
}

double reach_of(const SurfaceSkeleton& surface) {
  return reach_of(surface.rest_x_m, surface.rest_z_m, 0, surface.columns * surface.rows);
}

}  // namespace

double scenes_reach_m(std::span<const Skeleton* const> skeletons) noexcept {
  double farthest_m = 0.0;
  for (const Skeleton* skeleton : skeletons) {
    farthest_m = std::max(farthest_m, std::visit([](const auto& kind) { return reach_of(kind); }, *skeleton));
  }
  return farthest_m;
}

}  // namespace yuragi::pose
