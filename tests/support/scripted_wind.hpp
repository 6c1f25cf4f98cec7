#pragma once

#include <cstdint>

#include "engine/wind/wind_vector.hpp"

namespace yuragi {

/// A wind that is the same on every machine to the last bit: sums, products and quotients alone. It swells from calm to
/// 12 m/s and dies away within 200 ticks, and meanwhile turns to and fro through about 250 degrees.
inline wind::Vector scripted_wind(std::uint64_t tick) {
  const auto wave = [](std::uint64_t at, std::uint64_t period) {  // a triangle: 0 at 0, 1 in the middle, 0 again
    const double phase = static_cast<double>(at % period) / static_cast<double>(period);
    return phase < 0.5 ? 2.0 * phase : 2.0 - 2.0 * phase;
  };
  const double speed_m_s = 12.0 * wave(tick, 200);
  const double half_angle_tangent = 4.0 * wave(tick + 40, 330) - 2.0;
  const double square = half_angle_tangent * half_angle_tangent;
  return {speed_m_s * (1.0 - square) / (1.0 + square), speed_m_s * 2.0 * half_angle_tangent / (1.0 + square)};
}

}  // namespace yuragi
