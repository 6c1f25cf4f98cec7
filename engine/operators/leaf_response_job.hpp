#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "engine/base/simd_row.hpp"

namespace yuragi::operators {

/// The response of leaves to the wind at each place of a crown: their lean and their flutter.
///
/// The lean is lean_rad times bend_share() of s = wind / half_lean_speed, toward where the wind blows to. The deviation
/// of the flutter is flutter_rad (1 - (1 + q/8)^-8), q = (wind / flutter_speed)^2, which is 1 - exp(-q) to within 0.033
/// without an exponential: it grows with the square of a weak wind, and leaves in a strong one flutter no farther, but
/// faster (Tadrist and others 2018, "Foliage motion under wind, from leaf flutter to branch buffeting"). Calm gives
/// nothing, exactly. m/s, radians. All spans have the same size; the outputs overlap nothing else. Owns nothing.
/// Thread-safe: jobs with different outputs, yes. Realtime-safe: yes. Every SIMD row computes the same bits. Cost:
/// about 1 ns a place (x86-64-v3).
struct LeafResponseJob {
  std::span<const float> wind_east_m_s;  ///< at each place; finite, also their squares
  std::span<const float> wind_south_m_s;
  double half_lean_speed_m_s = 4.0;
  double flutter_speed_m_s = 5.0;
  double lean_rad = 0.4;
  double flutter_rad = 0.3;
  std::optional<SimdRow> row = std::nullopt;  ///< unset: the widest that this machine can run

  std::span<float> lean_east_rad;
  std::span<float> lean_south_rad;
  std::span<float> flutter_rad_each;

  enum class Problem : std::uint8_t {
    kNone,
    kSpeeds,  ///< half_lean_speed or flutter_speed is not a number from 0.01 to 1e6 m/s
    kAngles,  ///< lean or flutter is not finite
    kSizesDiffer,
    kRowNotRunnable,
  };
  [[nodiscard]] Problem validate() const noexcept;

  /// Runs the job unless validate() finds a problem; returns the result of validate().
  Problem run() const noexcept;

  /// The maximum slope of the flutter over wind / flutter_speed, for a flutter_rad of 1: at q = 8/17.
  static constexpr double kSteepestFlutter = 0.8202;
};

}  // namespace yuragi::operators
