#include "viewer/meshes/far_country.hpp"

#include <algorithm>
#include <cmath>

#include "engine/base/units.hpp"
#include "engine/math/philox.hpp"

namespace yuragi::viewer::meshes {
namespace {

float smoothly(float low, float high, float value) {
  const float share = std::clamp((value - low) / (high - low), 0.0F, 1.0F);
  return share * share * (3.0F - 2.0F * share);
}

/// The outline of one range at a `turn`, 0 to 1, around the circle.
class Outline {
 public:
  explicit Outline(std::size_t range)
      : range_(range),
        form_(kFarRanges.at(range)),
        random_(0, math::stream_id("viewer far country") + range),
        crowns_(static_cast<int>(2.0 * kPi * static_cast<double>(form_.distance_m) /
                                 (8.0 + 3.0 * static_cast<double>(range)))) {}

  float distance_m(float turn) const {
    return form_.distance_m + form_.distance_varies_m * (2.0F * wave(turn, 11, 11) - 1.0F);
  }

  /// Hills are round, mountains have ridges.
  float land_m(float turn) const {
    const bool has_ridges = range_ + 1 == kFarRanges.size();
    float sum = 0.0F;
    float weight = 0.55F;
    int cells = 7 + 2 * static_cast<int>(range_);
    for (int octave = 0; octave < 6; ++octave) {
      const float value = wave(turn, cells, octave);
      sum += weight * (has_ridges ? 1.0F - std::abs(2.0F * value - 1.0F) : value);
      weight *= has_ridges ? 0.48F : 0.40F;
      cells = 2 * cells + 3;
    }
    if (has_ridges) return form_.land_m * (0.15F + 0.85F * sum);
    return form_.land_m * (range_ == 1 ? sum : std::max(1.45F * sum - 0.35F, 0.02F));
  }

  /// Trees with gaps between them, and bushes.
  float trees_m(float turn) const {
    if (form_.trees_m == 0.0F) return 0.0F;
    const float dense = wave(turn, 37, 8) + 0.5F * (wave(turn, 211, 9) - 0.5F);
    const float grown = (range_ == 0 ? smoothly(0.50F, 0.62F, dense) : smoothly(0.15F, 0.35F, dense)) *
                        (0.55F + 0.45F * wave(turn, 97, 10));
    const float bushes = 0.22F * smoothly(0.30F, 0.40F, dense) * (0.4F + 0.6F * crowns(turn, 3 * crowns_, 24));
    const float trees = std::max(crowns(turn, crowns_, 12), 0.8F * crowns(turn, crowns_ * 7 / 4, 18));
    return form_.trees_m * std::max(trees * grown, bushes);
  }

 private:
  /// A number from 0 to 1 that stays with one of the `cells` of the circle.
  float chance(int cell, int cells, int kind) const {
    const int around = (cell % cells + cells) % cells;
    return static_cast<float>(
        random_.uniform(static_cast<std::uint64_t>(kind) << 32U | static_cast<std::uint64_t>(around)));
  }

  /// Smooth noise from 0 to 1.
  float wave(float turn, int cells, int kind) const {
    const float at = turn * static_cast<float>(cells);
    const float cell = std::floor(at);
    const float share = smoothly(0.0F, 1.0F, at - cell);
    const float low = chance(static_cast<int>(cell), cells, kind);
    return low + share * (chance(static_cast<int>(cell) + 1, cells, kind) - low);
  }

  /// Crowns side by side, 0 to 1: round ones, and some that are slender and pointed.
  float crowns(float turn, int cells, int kind) const {
    const float at = turn * static_cast<float>(cells);
    float top = 0.0F;
    for (int near = -1; near <= 1; ++near) {
      const int cell = static_cast<int>(std::floor(at)) + near;
      const float high = 0.45F + 0.55F * chance(cell, cells, kind);
      const float wide = 0.45F + 0.45F * chance(cell, cells, kind + 1);
      const float middle = static_cast<float>(cell) + 0.5F + 0.5F * (chance(cell, cells, kind + 2) - 0.5F);
      const float beside = std::abs(at - middle) / wide;
      const bool is_slender = chance(cell, cells, kind + 3) > 0.88F;
      const float outline =
          is_slender ? 1.25F * std::max(1.0F - 2.2F * beside, 0.0F) : std::sqrt(std::max(1.0F - beside * beside, 0.0F));
      top = std::max(top, high * outline);
    }
    return top;
  }

  std::size_t range_;
  FarRange form_;
  math::RandomStream random_;
  int crowns_;  // the number around the circle
};

}  // namespace

std::vector<FarCorner> far_corners(std::size_t range) {
  const Outline outline(range);
  constexpr float step = 1.0F / static_cast<float>(kFarCorners);
  std::vector<FarCorner> corners(kFarCorners + kFarCorners / 2 + 1);
  for (std::size_t i = 0; i < kFarCorners; ++i) {
    const float turn = step * static_cast<float>(i);
    const float bearing = static_cast<float>(2.0 * kPi) * turn;
    const float distance_m = outline.distance_m(turn);
    const float around_m = static_cast<float>(2.0 * kPi) * distance_m;
    corners[i].top_m = {std::sin(bearing) * distance_m, outline.land_m(turn) + outline.trees_m(turn),
                        -std::cos(bearing) * distance_m};
    corners[i].along_m = turn * around_m;
  }
  std::copy_n(corners.begin(), corners.size() - kFarCorners, corners.begin() + kFarCorners);
  return corners;
}

int far_corner_step(float apart_rad) {
  constexpr float kStep_rad = static_cast<float>(2.0 * kPi) / static_cast<float>(kFarCorners);
  int step = 1;
  for (const int wider : {2, 3, 4, 6, 8, 12}) {
    if (static_cast<float>(wider) * kStep_rad <= apart_rad) step = wider;
  }
  return step;
}

}  // namespace yuragi::viewer::meshes
