#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "engine/base/simd_row.hpp"

namespace yuragi::operators {

/// The projection operator of a tree's branches: from the two parts of the noise to a bend, in StrandPose's meaning
/// (Chiba, section 3.3):
///
///   theta = W_speed (N_vertical + alpha_vertical) / dist_to_wind_side
///   phi   = W_direction + W_speed (N_horizontal + beta_horizontal) / dist_to_wind_side
///
/// W_speed is the force of the mean wind and the noise that of its gusts (BranchForceJob): with an alpha of 1 theta
/// goes with the whole force at the branch. W_direction is the downwind direction there. The distance is in radii of
/// the tree (WindSideJob). The gain is the branch's own, in radians for a force of 1: larger for thinner wood. The
/// change of the rest pose's angles is limited by x / sqrt(1 + (x / max)^2): up to about ten degrees it is x, and no
/// wind bends a branch by more than max_tilt along the wind from the first line, nor than max_swing across it (to the
/// right of where it blows to) from the second, because a pose has no turn about the vertical. In calm air the bend is
/// exactly (0, 0).
///
/// Radians. All spans have the same size; the outputs overlap nothing else. Owns nothing. Thread-safe: jobs with
/// different outputs, yes. Realtime-safe: yes. Every SIMD row computes the same bits. Cost: about 1 ns a branch
/// (x86-64-v3).
struct TiltJob {
  double force = 0.0;                  ///< W_speed: 0 to 1e6
  std::span<const float> toward_east;  ///< downwind vector at each branch: no longer than 1
  std::span<const float> toward_south;
  std::span<const float> vertical;    ///< N_vertical
  std::span<const float> horizontal;  ///< N_horizontal
  std::span<const float> distance;    ///< above 0
  std::span<const float> gain;        ///< rad
  double alpha_vertical = 1.0;
  double beta_horizontal = 0.0;
  double max_tilt_rad = 1.0;                  ///< 0 to pi
  double max_swing_rad = 1.0;                 ///< 0 to pi
  std::optional<SimdRow> row = std::nullopt;  ///< unset: the widest that this machine can run

  std::span<float> bend_east_rad;
  std::span<float> bend_south_rad;

  enum class Problem : std::uint8_t {
    kNone,
    kForce,      ///< not a number from 0 to 1e6
    kConstants,  ///< alpha or beta is not finite
    kMaxAngles,  ///< max_tilt or max_swing is not a number from 0 to pi
    kSizesDiffer,
    kRowNotRunnable,
  };
  [[nodiscard]] Problem validate() const noexcept;

  /// Runs the job unless validate() finds a problem; returns the result of validate().
  Problem run() const noexcept;
};

}  // namespace yuragi::operators
