#include "viewer/meshes/ground_map.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace yuragi::viewer::meshes {
namespace {

constexpr float kTexel_m = GrowthMap::kSide_m / static_cast<float>(GrowthMap::kTexels);
constexpr float kLawn = 0.25F;        // the growth of a lawn
constexpr float kMargin_m = 0.8F;     // of lawn around a thing
constexpr float kSlope_m = 2.8F;      // from there on to tall grass
constexpr float kTrampled_m = 0.45F;  // around a fire
constexpr float kShore_m = 0.5F;      // around water, without blades
/// A texel with so many blades, of those that its area has on average, is taken as full.
constexpr float kFullTexel = 0.5F;

float smooth(float t) {
  const float x = std::clamp(t, 0.0F, 1.0F);
  return x * x * (3.0F - 2.0F * x);
}

std::size_t texel_of(float at_m) {
  const float texel = std::floor((at_m + 0.5F * GrowthMap::kSide_m) / kTexel_m);
  return static_cast<std::size_t>(std::clamp(texel, 0.0F, static_cast<float>(GrowthMap::kTexels - 1)));
}

float middle_m(std::size_t texel) {
  return (static_cast<float>(texel) + 0.5F) * kTexel_m - 0.5F * GrowthMap::kSide_m;
}

bool is_on_map(float x_m, float z_m) {
  return std::max(std::abs(x_m), std::abs(z_m)) < 0.5F * GrowthMap::kSide_m;
}

}  // namespace

Stand stand_of(const pose::StrandSkeleton& skeleton) {
  Stand stand;
  if (skeleton.strand_count == 0) return stand;
  const auto count = static_cast<float>(skeleton.strand_count);
  const auto links = static_cast<float>(skeleton.links_per_strand);
  float length_m = 0.0F;
  float curl_rad = 0.0F;
  float tilt_rad = 0.0F;
  for (std::size_t i = 0; i < skeleton.strand_count; ++i) {
    length_m += skeleton.link_length_m[i] * links;
    curl_rad += skeleton.rest_curl_rad[i] * links;
    tilt_rad += std::acos(std::clamp(skeleton.rest_y[i], -1.0F, 1.0F));
  }
  const Bounds bounds = bounds_of(skeleton);
  const float area_m2 = (bounds.high_m.x - bounds.low_m.x) * (bounds.high_m.z - bounds.low_m.z);
  stand.length_m = std::clamp(length_m / count, 0.02F, 3.0F);
  stand.curl_rad = std::clamp(curl_rad / count, 0.0F, 3.0F);
  stand.tilt_rad = std::clamp(tilt_rad / count, 0.0F, 1.0F);
  stand.blades_per_m2 = std::clamp(count / std::max(area_m2, 0.01F), 20.0F, 4000.0F);
  return stand;
}

BendGrid bend_grid_of(const pose::StrandSkeleton& skeleton) {
  BendGrid grid;
  if (skeleton.columns < 2 || skeleton.strand_count < 2 * skeleton.columns) return grid;
  const std::size_t rows = skeleton.strand_count / skeleton.columns;
  const auto place_m = [&](std::size_t i) { return glm::vec2(skeleton.root_x_m[i], skeleton.root_z_m[i]); };
  const glm::vec2 first_m = place_m(0);
  const glm::vec2 row_m = place_m(skeleton.columns - 1) - first_m;
  const glm::vec2 column_m = place_m((rows - 1) * skeleton.columns) - first_m;
  if (!(std::abs(row_m.x * column_m.y - row_m.y * column_m.x) > 1.0F)) return grid;  // of no area
  return {.columns = skeleton.columns,
          .rows = rows,
          .first_m = first_m,
          .to_next_m = row_m / static_cast<float>(skeleton.columns - 1),
          .to_next_row_m = column_m / static_cast<float>(rows - 1)};
}

GrowthMap::GrowthMap()
    : texels_(3 * kTexels * kTexels),
      growth_(kTexels * kTexels),
      blades_(kTexels * kTexels),
      water_(kTexels * kTexels) {
  make({});
}

void GrowthMap::make(std::span<const Standing> things) {
  std::ranges::fill(growth_, 1.0F);
  std::ranges::fill(blades_, 0.0F);
  std::ranges::fill(water_, 0.0F);
  for (const Standing& thing : things) {
    if (thing.kind == Standing::Kind::kGrass && thing.blades != nullptr) {
      const float full = kFullTexel * stand_of(*thing.blades).blades_per_m2 * kTexel_m * kTexel_m;
      for (std::size_t i = 0; i < thing.blades->strand_count; ++i) {
        const float x_m = thing.blades->root_x_m[i];
        const float z_m = thing.blades->root_z_m[i];
        if (is_on_map(x_m, z_m)) blades_[texel_of(z_m) * kTexels + texel_of(x_m)] += 1.0F / std::max(full, 0.5F);
      }
      continue;
    }
    // On the ground that water takes no blade stands.
    const bool is_water = thing.kind == Standing::Kind::kWater;
    const Bounds& box = thing.bounds;
    const float reach_m = kMargin_m + kSlope_m;
    for (std::size_t row = texel_of(box.low_m.z - reach_m); row <= texel_of(box.high_m.z + reach_m); ++row) {
      for (std::size_t column = texel_of(box.low_m.x - reach_m); column <= texel_of(box.high_m.x + reach_m); ++column) {
        const glm::vec2 at(middle_m(column), middle_m(row));
        const glm::vec2 out =
            glm::max(glm::max(glm::vec2(box.low_m.x, box.low_m.z) - at, at - glm::vec2(box.high_m.x, box.high_m.z)),
                     glm::vec2(0.0F));
        const float out_m = glm::length(out);
        float growth = kLawn + (1.0F - kLawn) * smooth((out_m - kMargin_m) / kSlope_m);
        if (thing.kind == Standing::Kind::kFire) growth *= smooth((out_m - kTrampled_m) / kTrampled_m);
        if (is_water && out_m <= kShore_m) {
          float& water = water_[row * kTexels + column];
          water = std::max(water, thing.opacity);
        }
        float& there = growth_[row * kTexels + column];
        there = std::min(there, 1.0F + thing.opacity * (growth - 1.0F));
      }
    }
  }
  for (std::size_t i = 0; i < growth_.size(); ++i) {
    blades_[i] = std::min(blades_[i], 1.0F);
    texels_[3 * i] = static_cast<std::uint8_t>(255.0F * growth_[i] + 0.5F);
    texels_[3 * i + 1] = static_cast<std::uint8_t>(255.0F * blades_[i] + 0.5F);
    texels_[3 * i + 2] = static_cast<std::uint8_t>(255.0F * water_[i] + 0.5F);
  }
}

float GrowthMap::growth_at(float x_m, float z_m) const {
  return growth_[texel_of(z_m) * kTexels + texel_of(x_m)];
}

float GrowthMap::water_at(float x_m, float z_m) const {
  return water_[texel_of(z_m) * kTexels + texel_of(x_m)];
}

float GrowthMap::blades_at(float x_m, float z_m) const {
  return blades_[texel_of(z_m) * kTexels + texel_of(x_m)];
}

}  // namespace yuragi::viewer::meshes
