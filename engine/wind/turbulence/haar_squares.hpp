#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace yuragi::wind::turbulence {

/// The mean squares of differences between neighbouring means of 1, 2, 4 ... readings, over past readings, which fade:
/// Haar's variances (engine/wind/model.md W28). Thread-safe: no. Realtime-safe: yes.
class HaarSquares {
 public:
  static constexpr std::size_t kScales = 10;

  explicit HaarSquares(double memory_s) noexcept : memory_s_(memory_s) {}

  /// A difference between two neighbouring means of 2^scale readings each; `weight` (0 or more): how much it counts in
  /// the scale's mean square. A scale from kScales on, and what is not finite, is ignored.
  void add(std::size_t scale, double difference, double weight) noexcept {
    if (scale >= kScales || !std::isfinite(difference) || !std::isfinite(weight)) return;
    squares_[scale] += weight * (difference * difference);
    weights_[scale] += weight;
    counts_[scale] += 1.0;
  }

  /// What has been added fades: so much time has gone by.
  void forget(double dt_s) noexcept {
    const double kept = std::exp(-std::max(dt_s, 0.0) / memory_s_);
    for (auto* sums : {&squares_, &weights_, &counts_}) {
      for (double& sum : *sums) sum *= kept;
    }
  }

  /// How many differences of a scale (below kScales) are remembered, counted as independent ones: neighbouring
  /// differences overlap, so that 2^scale of them count about as one.
  double observations(std::size_t scale) const noexcept { return std::ldexp(counts_[scale], -static_cast<int>(scale)); }
  /// Their mean square; 0 where there are none, or all are 0.
  double mean(std::size_t scale) const noexcept {
    return weights_[scale] > 0.0 ? squares_[scale] / weights_[scale] : 0.0;
  }

 private:
  double memory_s_;
  std::array<double, kScales> squares_{}, weights_{}, counts_{};
};

}  // namespace yuragi::wind::turbulence
