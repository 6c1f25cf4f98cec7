#pragma once

#include <array>
#include <cstddef>
#include <optional>

namespace yuragi::daemon::values {

/// A sum over time, and its mean.
struct TimeSum {
  double value = 0.0, time_s = 0.0;

  void add(double what, double dt_s) noexcept {
    value += what * dt_s;
    time_s += dt_s;
  }
  double mean() const noexcept { return time_s > 0.0 ? value / time_s : 0.0; }
};

/// The mean of the last 3 s, of which the strongest is a gust (WMO-No. 8), in steps of a quarter of a second.
/// Thread-safe: no. Realtime-safe: yes.
class ThreeSecondMean {
 public:
  /// Returns the mean if a quarter of a second is over with this; otherwise nullopt.
  std::optional<double> add(double value, double dt_s) noexcept;

  /// Of the quarters that are over, and of the present one so far; 0 if nothing has been added.
  double mean() const noexcept;

 private:
  static constexpr std::size_t kParts = 12;

  std::array<TimeSum, kParts> parts_{};
  std::size_t part_ = 0;  ///< that is being filled
  double since_part_s_ = 0.0;
};

}  // namespace yuragi::daemon::values
