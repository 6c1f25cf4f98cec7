#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "engine/base/simd_row.hpp"

namespace yuragi::operators {

/// The wind at each branch as the noise that drives it: the relative difference of its force from that of the mean
/// wind, N = F(|u|) / F(mean) - 1, F being streamlined_drag(), so that F(mean) (1 + N) is the force at the branch; and
/// its direction, u / sqrt(|u|^2 + calm^2): nearly a unit vector, and (0, 0) in calm air, which has no direction. A
/// mean below calm_m_s is taken as that, so that the quotient is finite. m/s. All spans have the same size; the outputs
/// overlap nothing else. Owns nothing. Thread-safe: jobs with different outputs, yes. Realtime-safe: yes. Every SIMD
/// row computes the same bits. Cost: about 2 ns a branch (x86-64-v3).
struct BranchForceJob {
  double mean_m_s = 0.0;
  double streamline_speed_m_s = 6.0;
  double calm_m_s = 0.3;                      ///< above 0
  std::optional<SimdRow> row = std::nullopt;  ///< unset: the widest that this machine can run
  std::span<const float> wind_east_m_s;       ///< at each branch; finite, also their squares
  std::span<const float> wind_south_m_s;

  std::span<float> noise;
  std::span<float> toward_east;
  std::span<float> toward_south;

  enum class Problem : std::uint8_t {
    kNone,
    kMean,             ///< not a number from 0 to 1e6 m/s
    kStreamlineSpeed,  ///< not a number from 0.01 to 1e6 m/s
    kCalmSpeed,        ///< not a number from 0.01 to 1e6 m/s
    kSizesDiffer,
    kRowNotRunnable,
  };
  [[nodiscard]] Problem validate() const noexcept;

  /// F(mean), W_speed of TiltJob. For a job without a problem in validate().
  float mean_force() const noexcept;

  /// Runs the job unless validate() finds a problem; returns the result of validate().
  Problem run() const noexcept;
};

}  // namespace yuragi::operators
