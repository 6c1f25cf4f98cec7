#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "engine/base/simd_row.hpp"

namespace yuragi::operators {

/// The projection operator "bending": from the wind at each strand to its bend, in StrandPose's meaning. The noise of
/// one moment bends all links of a chain (Chiba, section 2-2 (3)).
///
/// The bend points downwind. Its angle is max_bend s^2 / (1 + s^2), s = wind * strength * flexibility /
/// half_bend_speed: like the drag of the air, it grows with the square of a weak wind; at s = 1 it is half of max_bend,
/// which no wind exceeds. Calm gives exactly (0, 0), and a stronger wind never bends less. The paper's Wind-speed and
/// theta (section 3.1) multiply here: the tip formula is a direction, theta is scaled by the wind before
/// (engine/METHOD.md M19, D1). m/s, radians. All spans have the same size; the outputs overlap nothing else. Owns
/// nothing. Thread-safe: jobs with different outputs, yes. Realtime-safe: yes. Every SIMD row computes the same bits.
/// Cost: about 0.3 ns a strand (x86-64-v3).
struct BendingJob {
  double wind_east_m_s = 0.0;
  double wind_south_m_s = 0.0;
  std::span<const float> strength;            ///< factor on the wind at each strand; negative values count as 0
  std::span<const float> flexibility;         ///< of each strand, at least 0: with 1, half bent at half_bend_speed_m_s
  double half_bend_speed_m_s = 7.0;           ///< at least 0.01
  double max_bend_rad = 1.4;                  ///< 0 to pi
  std::optional<SimdRow> row = std::nullopt;  ///< unset: the widest that this machine can run

  std::span<float> bend_east_rad;
  std::span<float> bend_south_rad;

  enum class Problem : std::uint8_t {
    kNone,
    kWindNotFinite,  ///< or so strong (1e154 m/s) that its square is not
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
