#pragma once

#include <limits>

namespace yuragi::wind::shaping {

/// Limits the wind: up to `from_m_s` it is unchanged, bit for bit; above, the excess is compressed, so that it never
/// reaches `most_m_s` (which is larger). A gust in a storm stays a gust: the curve is s + R x/(1 + x) with R = most -
/// from and x = (speed - from)/R, strictly rising, with a continuous slope at the beginning. Without values the wind is
/// unchanged. Thread-safe and realtime-safe: yes.
struct SoftCeiling {
  double from_m_s = std::numeric_limits<double>::infinity();
  double most_m_s = std::numeric_limits<double>::infinity();

  /// The factor for a wind of this speed (at least 0): above 0, at most 1.
  double gain(double speed_m_s) const noexcept {
    if (!(speed_m_s > from_m_s)) return 1.0;
    const double range_m_s = most_m_s - from_m_s;
    const double above = (speed_m_s - from_m_s) / range_m_s;
    return (from_m_s + range_m_s * (above / (1.0 + above))) / speed_m_s;
  }
};

}  // namespace yuragi::wind::shaping
