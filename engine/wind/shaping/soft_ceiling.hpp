#pragma once

#include <limits>

namespace yuragi::wind::shaping {

/// How strong a wind may come through: up to `from_m_s` as it is, bit for bit; above, less and less of what is more, so
/// that it never reaches `most_m_s` (which is the larger). A gust in a storm stays a gust: the curve is s + R x/(1 + x)
/// with R = most - from and x = (speed - from)/R, strictly rising, and it leaves the straight line without a kink.
/// Without values it lets everything through. Thread-safe and realtime-safe: yes.
struct SoftCeiling {
  double from_m_s = std::numeric_limits<double>::infinity();
  double most_m_s = std::numeric_limits<double>::infinity();

  /// What is left of a wind of this speed (at least 0), as a factor: above 0, at most 1.
  double gain(double speed_m_s) const noexcept {
    if (!(speed_m_s > from_m_s)) return 1.0;
    const double range_m_s = most_m_s - from_m_s;
    const double above = (speed_m_s - from_m_s) / range_m_s;
    return (from_m_s + range_m_s * (above / (1.0 + above))) / speed_m_s;
  }
};

}  // namespace yuragi::wind::shaping
