#include "viewer/meshes/sward.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/base/units.hpp"
#include "engine/math/philox.hpp"

namespace yuragi::viewer::meshes {
namespace {

/// The R2 sequence: any first part of it fills the square evenly (M. Roberts 2018, "The unreasonable effectiveness of
/// quasirandom sequences").
constexpr double kR2First = 0.7548776662466927;
constexpr double kR2Second = 0.5698402909980532;
constexpr double kStray = 0.7;  // relative to the blades' spacing

double part_of(double value) {
  return value - std::floor(value);
}

}  // namespace

float Thinning::share(float distance_m) const {
  const float r = std::max(distance_m, 0.01F);
  return std::min(1.0F, factor() / (r * std::sqrt(r)));
}

std::vector<SwardBlade> sward_blades(std::size_t count) {
  const math::RandomStream chance(0, math::stream_id("viewer sward"));
  std::vector<SwardBlade> blades(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto draw = [&](std::size_t k) { return chance.uniform(8 * i + k); };
    const auto n = static_cast<double>(i + 1);
    const double stray = kStray / std::sqrt(n);
    blades[i] = {.x = static_cast<float>(part_of(0.5 + kR2First * n + stray * (draw(0) - 0.5))),
                 .z = static_cast<float>(part_of(0.5 + kR2Second * n + stray * (draw(1) - 0.5))),
                 .facing_rad = static_cast<float>(draw(2) * 2.0 * kPi),
                 .height = static_cast<float>(0.65 + 0.35 * draw(3) + 0.35 * draw(4)),
                 .heading_rad = static_cast<float>(draw(5) * 2.0 * kPi),
                 .chance = static_cast<float>(draw(6)),
                 .droop = static_cast<float>(0.4 + 1.2 * draw(7)),
                 .sway = static_cast<float>(0.75 + 0.5 * draw(4))};
  }
  return blades;
}

std::size_t GrassDetail::rings(float length_m, float distance_m, float pixel_m) const {
  const float height_px = length_m / (pixel_m * std::max(distance_m, 1e-3F));
  return static_cast<std::size_t>(std::clamp(std::round(std::sqrt(height_px / (8.0F * off_px))), 1.0F, 1e6F));
}

void SwardTiles::find_in_view(const View& view) {
  if (blades_ == 0) return;
  const std::array<glm::vec4, 5> planes = side_planes(view);
  const glm::vec3 eye_m(view.eye_m);
  const float reach_m = detail_.reach_m;
  const auto first = [&](float eye_axis_m) { return static_cast<int>(std::floor((eye_axis_m - reach_m) / kTile_m)); };
  const auto last = [&](float eye_axis_m) { return static_cast<int>(std::floor((eye_axis_m + reach_m) / kTile_m)); };
  const math::RandomStream chance(0, math::stream_id("viewer sward tiles"));
  for (int row = first(eye_m.z); row <= last(eye_m.z); ++row) {
    for (int column = first(eye_m.x); column <= last(eye_m.x); ++column) {
      const glm::vec3 low_m(static_cast<float>(column) * kTile_m, 0.0F, static_cast<float>(row) * kTile_m);
      const glm::vec3 high_m = low_m + glm::vec3(kTile_m, height_m_, kTile_m);
      // Blades may lean out of the tile.
      const glm::vec3 lean_m(0.7F * height_m_, 0.0F, 0.7F * height_m_);
      if (!is_in_view(planes, low_m - lean_m, high_m + lean_m)) continue;
      // Ranks are compared at the feet.
      const float distance_m = glm::distance(eye_m, glm::clamp(eye_m, low_m, {high_m.x, 0.0F, high_m.z}));
      if (distance_m > reach_m) continue;
      const std::size_t rings = std::min(detail_.rings(length_m_, distance_m, view.eye_m.w), kLevels);
      const float blades = std::ceil(static_cast<float>(blades_) * thinning_.share(distance_m));
      const auto number = static_cast<std::uint64_t>(static_cast<std::uint32_t>(row)) << 32U |
                          static_cast<std::uint64_t>(static_cast<std::uint32_t>(column));
      candidates_.push_back({.tile = {.origin_m = {low_m.x, low_m.z},
                                      .turn = std::floor(static_cast<float>(chance.uniform(number)) * 7.99F),
                                      .blades = blades},
                             .level = kLevels - rings,
                             .distance_m = distance_m});
    }
  }
  std::ranges::sort(candidates_, {}, &Candidate::distance_m);
}

std::vector<std::uint32_t> ribbon_triangles(std::size_t count, std::size_t rings) {
  const std::size_t corners = 2 * rings + 1;
  std::vector<std::uint32_t> indices;
  indices.reserve(count * 3 * (corners - 2));
  for (std::size_t ribbon = 0; ribbon < count; ++ribbon) {
    for (std::size_t corner = 0; corner + 2 < corners; ++corner) {
      for (std::size_t k = 0; k < 3; ++k) indices.push_back(static_cast<std::uint32_t>(ribbon * corners + corner + k));
    }
  }
  return indices;
}

}  // namespace yuragi::viewer::meshes
