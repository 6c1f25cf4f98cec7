#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "engine/base/simd_row.hpp"

namespace yuragi {

/// The projection operator of a tree's branches: from the two parts of the noise to a bend, in StrandPose's meaning
/// (Chiba, section 3.3):
///
///   theta = W_speed (N_vertical + alpha_vertical) / dist_to_wind_side
///   phi   = W_direction + W_speed (N_horizontal + beta_horizontal) / dist_to_wind_side
///
/// To make that a matter of numbers without units which saturates, W_speed is s^2 / (1 + s^2), s = wind /
/// half_tilt_speed; the distance is in radii of the tree (WindSideJob); and what is added to the rest pose's own angles
/// goes through x / sqrt(1 + x^2) before it becomes one: a bend of at most max_tilt along the wind from the first line,
/// and of at most max_swing across it (to the right of where it blows to) from the second, since a pose has no turn
/// about the vertical. The gain, (root thickness / thickness)^p over that of the thinnest branch, multiplies both. Calm
/// gives (0, 0).
///
/// m/s, radians. All spans have the same size; the outputs overlap nothing else. Owns nothing. Thread-safe: jobs with
/// different outputs, yes. Realtime-safe: yes. Every SIMD row computes the same bits. Cost: about 1 ns a branch
/// (x86-64-v3).
struct TiltJob {
  double wind_east_m_s = 0.0;
  double wind_south_m_s = 0.0;
  std::span<const float> vertical;    ///< N_vertical at each branch
  std::span<const float> horizontal;  ///< N_horizontal
  std::span<const float> distance;    ///< above 0
  std::span<const float> gain;        ///< 0 to 1
  double half_tilt_speed_m_s = 10.0;  ///< at least 0.01
  double alpha_vertical = 0.0;
  double beta_horizontal = 0.0;
  double max_tilt_rad = 0.6;                  ///< 0 to pi
  double max_swing_rad = 0.6;                 ///< 0 to pi
  std::optional<SimdRow> row = std::nullopt;  ///< unset: the widest that this machine can run

  std::span<float> bend_east_rad;
  std::span<float> bend_south_rad;

  enum class Problem : std::uint8_t {
    kNone,
    kWindNotFinite,  ///< or so strong (1e154 m/s) that its square is not
    kHalfTiltSpeed,  ///< not a number of at least 0.01 m/s
    kConstants,      ///< alpha or beta is not finite
    kLargestAngles,  ///< max_tilt or max_swing is not a number from 0 to pi
    kSizesDiffer,
    kRowNotRunnable,
  };
  [[nodiscard]] Problem validate() const noexcept;

  /// Does the work, if validate() has nothing against it; returns what validate() says.
  Problem run() const noexcept;
};

}  // namespace yuragi
