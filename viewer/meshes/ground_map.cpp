#include "viewer/meshes/ground_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/math/philox.hpp"

namespace yuragi::viewer::meshes {
namespace {

constexpr float kTexel_m = GrowthMap::kSide_m / static_cast<float>(GrowthMap::kTexels);
constexpr float kLawn = 0.25F;         // the growth of a lawn
constexpr float kMargin_m = 0.8F;      // width of the lawn around a thing
constexpr float kSlope_m = 4.0F;       // from a lawn's border to tall grass
constexpr float kShore_m = 0.5F;       // around water, without blades
constexpr float kFloorEdge_m = 0.05F;  // beyond this distance blades grow again
constexpr float kTrampled_m = 1.6F;  // around a fire, until grass is whole: some texels, so that the border is a circle
constexpr float kUnderFire_m = 0.2F;      // part of it inside the fire's border
constexpr float kTrampledWander = 0.25F;  // how far the lawn's border varies
/// A texel with this share of its usual number of blades counts as full.
constexpr float kFullTexel = 0.5F;

float smooth(float t) {
  const float x = std::clamp(t, 0.0F, 1.0F);
  return x * x * (3.0F - 2.0F * x);
}

/// How far a lawn's border varies beyond its margin: maximum distance, and length of a variation.
struct Wander {
  float most_m;
  float length_m;
};
constexpr std::array<Wander, 3> kWander{{{1.2F, 7.0F}, {0.7F, 2.9F}, {0.3F, 1.3F}}};
constexpr float kMaxWander_m = kWander[0].most_m + kWander[1].most_m + kWander[2].most_m;

/// Smooth noise from 0 to 1, the same for the same seed: random values on a grid of spacing 1, interpolated.
float noise_at(const glm::vec2& at, std::uint64_t seed) {
  const math::RandomStream random(seed, math::stream_id("lawn borders"));
  const glm::vec2 low = glm::floor(at);
  const auto chance_at = [&](float column, float row) {
    return static_cast<float>(random.uniform(static_cast<std::uint64_t>(1000.0F * (row + 500.0F) + column + 500.0F)));
  };
  const float across = smooth(at.x - low.x);
  const float north = glm::mix(chance_at(low.x, low.y), chance_at(low.x + 1.0F, low.y), across);
  const float south = glm::mix(chance_at(low.x, low.y + 1.0F), chance_at(low.x + 1.0F, low.y + 1.0F), across);
  return glm::mix(north, south, smooth(at.y - low.y));
}

/// How far a lawn's border is beyond its margin at a place: from 0 to kMaxWander_m.
float wander_m_at(const glm::vec2& at_m) {
  float sum_m = 0.0F;
  for (std::size_t i = 0; i < kWander.size(); ++i) {
    sum_m += kWander[i].most_m * noise_at(at_m / kWander[i].length_m, i);
  }
  return sum_m;
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
  wander_m_.reserve(kTexels * kTexels);
  for (std::size_t row = 0; row < kTexels; ++row) {
    for (std::size_t column = 0; column < kTexels; ++column) {
      wander_m_.push_back(wander_m_at({middle_m(column), middle_m(row)}));
    }
  }
  make({});
}

void GrowthMap::make(std::span<const Standing> things, float most) {
  std::ranges::fill(growth_, most);
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
    // No blade stands on ground that water covers.
    const bool is_water = thing.kind == Standing::Kind::kWater;
    const Bounds box = thing.floor ? united(thing.bounds, bounds_of(*thing.floor)) : thing.bounds;
    const float reach_m = kMargin_m + kMaxWander_m + kSlope_m;
    for (std::size_t row = texel_of(box.low_m.z - reach_m); row <= texel_of(box.high_m.z + reach_m); ++row) {
      for (std::size_t column = texel_of(box.low_m.x - reach_m); column <= texel_of(box.high_m.x + reach_m); ++column) {
        const glm::vec2 at(middle_m(column), middle_m(row));
        const glm::vec2 out =
            glm::max(glm::max(glm::vec2(box.low_m.x, box.low_m.z) - at, at - glm::vec2(box.high_m.x, box.high_m.z)),
                     glm::vec2(0.0F));
        float out_m = glm::length(out);
        float is_taken =
            (is_water && out_m <= kShore_m) || (thing.floor && is_on(*thing.floor, at, kFloorEdge_m)) ? 1.0F : 0.0F;
        if (is_water && thing.shore != nullptr) {
          // The number of blades decreases down the bank. A shore is finer than a texel, but not than the interpolation
          // between two.
          out_m = thing.shore->out_m(at) - 0.6F * thing.shore->bank_m(at);
          is_taken = std::clamp(0.4F - out_m / kTexel_m, 0.0F, 1.0F);
        }
        const float border_m = wander_m_[row * kTexels + column];
        float growth = kLawn + (1.0F - kLawn) * smooth((out_m - kMargin_m - border_m) / kSlope_m);
        const glm::vec2 half_m =
            glm::max(0.5F * glm::vec2(box.high_m.x - box.low_m.x, box.high_m.z - box.low_m.z), 0.1F);
        const glm::vec2 off_m = at - glm::vec2(box.low_m.x, box.low_m.z) - half_m;
        if (thing.kind == Standing::Kind::kFire) {
          // A fire is round, too: the box has corners.
          const float round_m = glm::length(off_m) - std::min(half_m.x, half_m.y);
          growth *= smooth((round_m + kUnderFire_m - kTrampledWander * border_m) / kTrampled_m);
        }
        if (thing.kind == Standing::Kind::kFur) {
          // An animal lies in the tall grass, because its body is round.
          growth = kLawn + (1.0F - kLawn) *
                               smooth((glm::length(off_m / half_m) - 0.7F) * std::min(half_m.x, half_m.y) / kTexel_m);
        }
        float& water = water_[row * kTexels + column];
        water = std::max(water, is_taken * thing.opacity);
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

bool GrowthMap::is_free(const glm::vec2& low_m, const glm::vec2& high_m, bool is_tall) const {
  // The shader interpolates between texels: those around count, too.
  for (std::size_t row = texel_of(low_m.y - kTexel_m); row <= texel_of(high_m.y + kTexel_m); ++row) {
    for (std::size_t column = texel_of(low_m.x - kTexel_m); column <= texel_of(high_m.x + kTexel_m); ++column) {
      const std::size_t texel = row * kTexels + column;
      if (water_[texel] < 1.0F && (!is_tall || blades_[texel] < 1.0F)) return true;
    }
  }
  return false;
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
