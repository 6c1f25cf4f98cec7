#pragma once

#include <numbers>

namespace yuragi {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kRadPerDeg = kPi / 180.0;
constexpr double radians_of(double degrees) noexcept {
  return degrees * kRadPerDeg;
}

// Speeds: multiply by these to get m/s.
inline constexpr double kMetresPerSecondPerKnot = 1852.0 / 3600.0;
inline constexpr double kMetresPerSecondPerKmh = 1.0 / 3.6;
inline constexpr double kMetresPerSecondPerMph = 0.44704;

}  // namespace yuragi
