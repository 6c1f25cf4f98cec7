#include "viewer/meshes/bounds.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace yuragi::viewer::meshes {
namespace {

constexpr float kSwingPerLength = 0.45F;  // how far a hanging cloth swings out
constexpr float kFlyPerLength = 0.9F;     // a flag's reach in whatever direction it flies
constexpr float kWaveRoom_m = 0.05F;      // above and below a surface
constexpr float kRimPerSide = 0.05F;      // of a basin around water

glm::vec3 joint_at_rest(const pose::GridSkeleton& cloth, std::size_t column, std::size_t row) {
  const std::size_t i = row * cloth.stride() + column;
  return {cloth.rest_x_m[i], cloth.rest_y_m[i], cloth.rest_z_m[i]};
}

/// From the root of a strand at rest to its tip, along the arc (skeleton.hpp).
glm::vec3 chord_m(const pose::StrandSkeleton& s, std::size_t strand) {
  const glm::vec3 rest(s.rest_x[strand], s.rest_y[strand], s.rest_z[strand]);
  const glm::vec3 curl(s.curl_x[strand], s.curl_y[strand], s.curl_z[strand]);
  glm::vec3 sum(0.0F);
  for (std::size_t link = 0; link < s.links_per_strand; ++link) {
    const float turn_rad = static_cast<float>(link) * s.rest_curl_rad[strand];
    sum += std::cos(turn_rad) * rest + std::sin(turn_rad) * curl;
  }
  return s.link_length_m[strand] * sum;
}

Bounds widened(const Bounds& bounds, const glm::vec3& by_m) {
  return {bounds.low_m - by_m, bounds.high_m + by_m};
}

}  // namespace

Bounds united(const Bounds& a, const Bounds& b) {
  return {glm::min(a.low_m, b.low_m), glm::max(a.high_m, b.high_m)};
}

Bounds bounds_of(const pose::StrandSkeleton& strands) {
  if (strands.strand_count == 0) return {};
  Bounds bounds{glm::vec3(1e9F), glm::vec3(-1e9F)};
  for (std::size_t i = 0; i < strands.strand_count; ++i) {
    const glm::vec3 root(strands.root_x_m[i], strands.root_y_m[i], strands.root_z_m[i]);
    const float length_m = strands.link_length_m[i] * static_cast<float>(strands.links_per_strand);
    bounds = united(bounds, {root, root + glm::vec3(0.0F, length_m, 0.0F)});
  }
  return bounds;
}

Bounds bounds_of(const pose::GridSkeleton& cloth) {
  if (cloth.columns == 0 || cloth.rows == 0) return {};
  Bounds fixed{joint_at_rest(cloth, 0, 0), joint_at_rest(cloth, 0, 0)};
  Bounds whole = fixed;
  float length_m = 0.0F;
  for (std::size_t row = 0; row < cloth.rows; ++row) {
    for (std::size_t column = 0; column < cloth.columns; ++column) {
      const glm::vec3 joint = joint_at_rest(cloth, column, row);
      whole = united(whole, {joint, joint});
      if (row == 0) fixed = united(fixed, {joint, joint});
    }
    if (row > 0) length_m += glm::distance(joint_at_rest(cloth, 0, row), joint_at_rest(cloth, 0, row - 1));
  }

  // A cloth with an upright fixed edge (a flag) flies to any side; one that hangs from above swings out.
  const glm::vec3 edge_m = fixed.high_m - fixed.low_m;
  const bool is_hoisted = edge_m.y > std::max(edge_m.x, edge_m.z);
  const float reach_m = (is_hoisted ? kFlyPerLength : kSwingPerLength) * length_m;
  if (is_hoisted) return united(whole, widened(fixed, {reach_m, 0.0F, reach_m}));
  if (!cloth.is_first_column_fixed) return widened(whole, {0.3F * reach_m, 0.0F, 0.3F * reach_m});

  // An arm can turn to any side of its pole.
  const float arm_m = std::hypot(edge_m.x, edge_m.z);
  const glm::vec3 top = joint_at_rest(cloth, 0, 0);
  return united(whole, widened({top, top}, {arm_m, 0.0F, arm_m}));
}

Bounds bounds_of(const pose::TreeSkeleton& tree) {
  Bounds bounds{glm::vec3(1e9F), glm::vec3(-1e9F)};
  bool is_empty = true;
  for (const pose::TreeLevel& level : tree.levels) {
    for (std::size_t i = 0; i < level.strands.strand_count; ++i) {
      const pose::StrandSkeleton& s = level.strands;
      const glm::vec3 root(s.root_x_m[i], s.root_y_m[i], s.root_z_m[i]);
      const glm::vec3 tip = root + chord_m(s, i);
      bounds = united(bounds, {glm::min(root, tip), glm::max(root, tip)});
      is_empty = false;
    }
  }
  if (is_empty) return {};
  // A copy can be turned to any side of its foot.
  const pose::StrandSkeleton& trunk = tree.levels.front().strands;
  const glm::vec3 foot = trunk.strand_count > 0 ? glm::vec3(trunk.root_x_m[0], trunk.root_y_m[0], trunk.root_z_m[0])
                                                : (bounds.low_m + bounds.high_m) / 2.0F;
  const glm::vec3 reach_m = glm::max(bounds.high_m - foot, foot - bounds.low_m);
  const float aside_m = std::max(reach_m.x, reach_m.z);
  const float up_m = bounds.high_m.y - foot.y;
  for (std::size_t i = 0; i < tree.copies.x_m.size(); ++i) {
    const glm::vec3 at(tree.copies.x_m[i], foot.y, tree.copies.z_m[i]);
    const float scale = tree.copies.scale[i];
    bounds = united(bounds,
                    {at - scale * glm::vec3(aside_m, 0.0F, aside_m), at + scale * glm::vec3(aside_m, up_m, aside_m)});
  }
  return bounds;
}

Bounds bounds_of(const pose::SurfaceSkeleton& surface) {
  if (surface.rest_x_m.empty()) return {};
  const auto range = [](std::span<const float> values) { return std::minmax_element(values.begin(), values.end()); };
  const auto [low_x, high_x] = range(surface.rest_x_m);
  const auto [low_y, high_y] = range(surface.rest_y_m);
  const auto [low_z, high_z] = range(surface.rest_z_m);
  const Bounds bounds{{*low_x, *low_y, *low_z}, {*high_x, *high_y, *high_z}};
  const float side_m = std::max(*high_x - *low_x, *high_z - *low_z);
  const float rim_m = surface.ramp_rgba.empty() ? kRimPerSide * side_m : kWaveRoom_m;
  return widened(bounds, {rim_m, kWaveRoom_m, rim_m});
}

Bounds bounds_of(const pose::Skeleton& skeleton) {
  return std::visit([](const auto& kind) { return bounds_of(kind); }, skeleton);
}

}  // namespace yuragi::viewer::meshes
