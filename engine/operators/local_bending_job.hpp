#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "engine/base/simd_row.hpp"

namespace yuragi::operators {

/// BendingJob with a wind of its own for every strand: it bends downwind by max_bend s^2/(1 + s^2), s = speed *
/// strength * flexibility / half_bend_speed.
///
/// m/s, radians. All spans have the same size; the outputs overlap nothing else. Owns nothing. Thread-safe: jobs with
/// different outputs, yes. Realtime-safe: yes. Every SIMD row computes the same bits. Calm gives exactly (0, 0).
struct LocalBendingJob {
  std::span<const float> wind_east_m_s;       ///< finite
  std::span<const float> wind_south_m_s;      ///< finite
  std::span<const float> strength;            ///< factor on its wind, at least 0
  std::span<const float> flexibility;         ///< of each strand, at least 0: with 1, half bent at half_bend_speed_m_s
  double half_bend_speed_m_s = 7.0;           ///< at least 0.01
  double max_bend_rad = 1.4;                  ///< 0 to pi
  std::optional<SimdRow> row = std::nullopt;  ///< unset: the widest that this machine can run

  std::span<float> bend_east_rad;
  std::span<float> bend_south_rad;

  enum class Problem : std::uint8_t {
    kNone,
    kHalfBendSpeed,  ///< not a number of at least 0.01 m/s
    kMaxBend,        ///< not a number from 0 to pi
    kSizesDiffer,
    kRowNotRunnable,
  };
  [[nodiscard]] Problem validate() const noexcept;

  /// Runs the job unless validate() finds a problem; returns the result of validate().
  Problem run() const noexcept;
};

}  // namespace yuragi::operators
