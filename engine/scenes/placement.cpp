#include "engine/scenes/placement.hpp"

#include <cmath>
#include <span>

#include "engine/base/units.hpp"

namespace yuragi::scenes {

/// x east, z south: clockwise from above turns north (-z) to east (+x).
void turn(const Placement& placement, std::span<float> x, std::span<float> z) noexcept {
  if (placement.heading_deg == 0.0) return;
  const double cos = std::cos(placement.heading_deg * kRadPerDeg);
  const double sin = std::sin(placement.heading_deg * kRadPerDeg);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const auto old_x = static_cast<double>(x[i]);
    const auto old_z = static_cast<double>(z[i]);
    x[i] = static_cast<float>(cos * old_x - sin * old_z);
    z[i] = static_cast<float>(sin * old_x + cos * old_z);
  }
}

namespace {

void move(double way_m, std::span<float> values_m) noexcept {
  if (way_m == 0.0) return;
  for (float& value_m : values_m) value_m = static_cast<float>(static_cast<double>(value_m) + way_m);
}

void turn_and_move(const Placement& placement, std::span<float> x_m, std::span<float> y_m,
                   std::span<float> z_m) noexcept {
  turn(placement, x_m, z_m);
  move(placement.x_m, x_m);
  move(placement.y_m, y_m);
  move(placement.z_m, z_m);
}

}  // namespace

void place(const Placement& placement, pose::StrandSkeleton& strands) noexcept {
  turn_and_move(placement, strands.root_x_m, strands.root_y_m, strands.root_z_m);
  turn(placement, strands.rest_x, strands.rest_z);
  turn(placement, strands.curl_x, strands.curl_z);
}

void place(const Placement& placement, pose::GridSkeleton& grid) noexcept {
  turn_and_move(placement, grid.rest_x_m, grid.rest_y_m, grid.rest_z_m);
}

void place(const Placement& placement, pose::TreeSkeleton& tree) noexcept {
  for (pose::TreeLevel& level : tree.levels) place(placement, level.strands);
  turn(placement, tree.copies.x_m, tree.copies.z_m);
  move(placement.x_m, tree.copies.x_m);
  move(placement.z_m, tree.copies.z_m);
}

void place(const Placement& placement, pose::SurfaceSkeleton& surface) noexcept {
  turn_and_move(placement, surface.rest_x_m, surface.rest_y_m, surface.rest_z_m);
  turn(placement, surface.normal_x, surface.normal_z);
  turn(placement, surface.axis_x_m, surface.axis_z_m);
  move(placement.x_m, surface.axis_x_m);
  move(placement.z_m, surface.axis_z_m);
}

}  // namespace yuragi::scenes
