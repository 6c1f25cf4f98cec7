#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "engine/base/state_pass.hpp"

namespace yuragi::wind::turbulence {

/// The mean squares of differences between neighbouring means of 1, 2, 4 ... readings, over past readings with a fading
/// memory: Haar's variances (engine/wind/model.md W28). Thread-safe: no. Realtime-safe: yes.
class HaarSquares {
 public:
  static constexpr std::size_t kScales = 10;

  explicit HaarSquares(double memory_s) noexcept : memory_s_(memory_s) {}

  /// Adds a difference between two neighbouring means of 2^scale readings each; `weight` (0 or more): its weight in the
  /// scale's mean square. Scales from kScales on, and values that are not finite, are ignored.
  void add(std::size_t scale, double difference, double weight) noexcept {
    if (scale >= kScales || !std::isfinite(difference) || !std::isfinite(weight)) return;
    squares_[scale] += weight * (difference * difference);
    weights_[scale] += weight;
    counts_[scale] += 1.0;
  }

  /// Fades the memory by dt_s.
  void forget(double dt_s) noexcept {
    const double kept = std::exp(-std::max(dt_s, 0.0) / memory_s_);
    for (auto* sums : {&squares_, &weights_, &counts_}) {
      for (double& sum : *sums) sum *= kept;
    }
  }

  /// The number of remembered differences of a scale (below kScales), counted as independent ones: neighbouring
  /// differences overlap, so that 2^scale of them count as about one.
  double observations(std::size_t scale) const noexcept { return std::ldexp(counts_[scale], -static_cast<int>(scale)); }
  /// Their mean square; 0 if there are none, or all are 0.
  double mean(std::size_t scale) const noexcept {
    return weights_[scale] > 0.0 ? squares_[scale] / weights_[scale] : 0.0;
  }

  void list_state(StatePass& pass) {
    for (auto* sums : {&squares_, &weights_, &counts_}) {
      for (double& sum : *sums) pass.within(sum, 0.0, StatePass::kLargestTotal);
    }
  }

 private:
  double memory_s_;
  std::array<double, kScales> squares_{}, weights_{}, counts_{};
};

}  // namespace yuragi::wind::turbulence
