#pragma once

#include <array>
#include <cstddef>

#include "daemon/values/quantity.hpp"
#include "daemon/values/three_second_mean.hpp"
#include "engine/wind/wind_vector.hpp"

namespace yuragi::daemon::values {

/// The speeds at which `norm` is 0.5 and 1; between them and below it is linear.
struct NormScale {
  double median_m_s = 6.0;
  double strong_m_s = 12.0;  ///< above the median, otherwise `norm` ends at 1 there

  /// From 0 to 1.
  double norm_of(double speed_m_s) const noexcept;
};

/// Derives all quantities of a wind from its vector, tick by tick. The same at every tick rate; a wind that is not
/// finite is ignored. Thread-safe: no. Realtime-safe: yes.
class Meter {
 public:
  /// `wind`: toward which the air moves, m/s east and north. `live`: the share of measured wind, 0 to 1. `age_s`: of
  /// the newest reading in it; ignored while `live` is 0, when the age grows with the time. `dt_s`: since the last
  /// call; at most a second counts.
  void add(wind::Vector wind, double live, double age_s, double dt_s, const NormScale& scale) noexcept;

  const Readout& readout() const noexcept { return readout_; }

 private:
  static constexpr std::size_t kMean_s = 100, kGusts_s = 600;

  void turn_second() noexcept;
  double mean_m_s() const noexcept;
  double gust_deviation_m_s(double mean_m_s) const noexcept;

  std::array<TimeSum, kMean_s> speeds_{};         ///< of the last seconds
  std::array<TimeSum, kGusts_s> squares_{};       ///< of the gust
  std::array<double, kGusts_s> strongest_m_s_{};  ///< 3 s that ended in each of the last seconds
  ThreeSecondMean gust_;
  std::size_t second_ = 0;            ///< since the beginning
  double since_second_s_ = 0.0;       ///< what the present one has lasted
  TimeSum all_speeds_, all_squares_;  ///< of the seconds that are over and not yet forgotten
  double peak_m_s_ = 0.0;             ///< of the seconds that are over
  Readout readout_;
};

}  // namespace yuragi::daemon::values
