#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace yuragi::wind::turbulence {

/// A positive function of a ratio from 1e-3 to 1e3, tabled at equal steps of the ratio's logarithm; its own logarithm
/// is interpolated linearly. Outside that range it has its value at the end. Thread-safe: reading, yes. Realtime-safe
/// after construction.
class RatioTable {
 public:
  template <class Function>
  explicit RatioTable(const Function& function) {
    for (std::size_t i = 0; i < kPoints; ++i) log_values_[i] = std::log(function(std::exp(log_ratio_of(i))));
  }

  double at(double ratio) const noexcept {
    const double place = (std::log(ratio) - log_ratio_of(0)) / step();
    const double inside = std::clamp(place, 0.0, static_cast<double>(kPoints - 1));
    const auto below = std::min(static_cast<std::size_t>(inside), kPoints - 2);
    const double t = inside - static_cast<double>(below);
    return std::exp((1.0 - t) * log_values_[below] + t * log_values_[below + 1]);
  }

 private:
  static constexpr std::size_t kPoints = 121;
  static double step() noexcept { return std::log(1e6) / static_cast<double>(kPoints - 1); }
  static double log_ratio_of(std::size_t i) noexcept { return std::log(1e-3) + step() * static_cast<double>(i); }

  std::array<double, kPoints> log_values_{};
};

}  // namespace yuragi::wind::turbulence
