#pragma once

#include <algorithm>
#include <cmath>

namespace yuragi {

/// The slowest that a speed scale may be: what answers so weak a wind has answered any.
inline constexpr double kSlowestResponseSpeed_m_s = 0.01;

/// How things that a wind moves answer it: by s^2 / (1 + s^2), s the wind over the speed that they answer half at. Like
/// the drag of the air it grows with the square of a weak wind, and it never reaches 1.
struct WindResponse {
  double strength = 0.0;     ///< 0 to 1
  double toward_east = 0.0;  ///< where the wind blows to: a unit vector; (0, 0) in calm air
  double toward_south = 0.0;

  /// The steepest that `strength` gets, over s: where s is 1 / sqrt(3).
  static constexpr double kSteepest = 0.6495190528383290;  // 3 sqrt(3) / 8

  /// Of a finite wind whose square is finite. Thread-safe and realtime-safe: yes.
  static WindResponse to(double wind_east_m_s, double wind_south_m_s, double half_speed_m_s) noexcept {
    const double speed_m_s = std::sqrt(wind_east_m_s * wind_east_m_s + wind_south_m_s * wind_south_m_s);
    if (!(speed_m_s > 0.0)) return {};
    const double s = std::min(speed_m_s / half_speed_m_s, 1e9);
    return {.strength = 1.0 - 1.0 / (1.0 + s * s),
            .toward_east = wind_east_m_s / speed_m_s,
            .toward_south = wind_south_m_s / speed_m_s};
  }
};

}  // namespace yuragi
