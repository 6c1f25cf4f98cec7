#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "engine/base/simd_row.hpp"

namespace yuragi::operators {

/// BendingJob for hairs on a body: the wind strokes along the skin, and opens partings.
///
/// With n the skin's outward normal at a hair, the wind along the skin there is u_t = u - (u . n) n: the part into the
/// skin bends nothing. The turn about a level axis that lays a hair from n toward u_t points downwind everywhere on the
/// body. So it bends downwind by
///
///   s^2 / (1 + s^2) (max_bend e + stroke * stroke_along)    s = |u_t| flexibility / half_bend_speed
///
/// and by s^2 / (1 + s^2) stroke * stroke_across to the right of it. The exposure e is 1 where the skin faces the wind
/// or stands along it, and falls to 1 - sheltered where it faces away.
/// m/s, radians. All spans have the same size; the outputs overlap nothing else. Owns nothing. Thread-safe: jobs with
/// different outputs, yes. Realtime-safe: yes. Every SIMD row computes the same bits. Calm gives exactly (0, 0).
struct CoatBendingJob {
  double wind_east_m_s = 0.0;  ///< finite, and its square too
  double wind_south_m_s = 0.0;
  std::span<const float> normal_x;  ///< of the skin, outward, of unit length
  std::span<const float> normal_z;
  std::span<const float> stroke_along;        ///< noise at each hair
  std::span<const float> stroke_across;       ///< the same, independent of it
  std::span<const float> flexibility;         ///< of each hair, at least 0: with 1, half bent at half_bend_speed_m_s
  double half_bend_speed_m_s = 5.5;           ///< at least 0.01
  double max_bend_rad = 1.4;                  ///< 0 to pi
  double stroke_rad = 0.28;                   ///< 0 to pi
  double sheltered = 0.6;                     ///< 0 to 1
  std::optional<SimdRow> row = std::nullopt;  ///< unset: the widest that this machine can run

  std::span<float> bend_east_rad;
  std::span<float> bend_south_rad;

  enum class Problem : std::uint8_t {
    kNone,
    kWindNotFinite,
    kHalfBendSpeed,  ///< not a number of at least 0.01 m/s
    kBend,           ///< max_bend or stroke is not a number from 0 to pi
    kSheltered,      ///< not a number from 0 to 1
    kSizesDiffer,
    kRowNotRunnable,
  };
  [[nodiscard]] Problem validate() const noexcept;

  /// Runs the job unless validate() finds a problem; returns the result of validate().
  Problem run() const noexcept;
};

}  // namespace yuragi::operators
