#pragma once

#include <cstdint>
#include <span>

namespace yuragi::operators {

/// The distance of parts from the windward side of their whole (dist_to_wind_side of Chiba, section 3.3), in units of
/// its radius: about 0 at the windward side, 1 in the middle, 2 on the lee.
///
/// It is 1 plus the projection of a part's place on the wind's unit vector, kept above `floor` by a smooth bend, so
/// that it changes smoothly as the wind veers: by no more than a place's distance from the middle times the angle
/// (engine/METHOD.md M29, D5). A calm has no windward side (D9), so the unit vector is taken as wind / sqrt(wind^2 +
/// calm^2): as the wind dies away, everything goes to 1, and nothing jumps when it returns from another direction.
/// Places in radii, x east, z south, from the middle. All spans have the same size. Owns nothing. Thread-safe: jobs
/// with different outputs, yes. Realtime-safe: yes; the same bits on every machine.
struct WindSideJob {
  double wind_east_m_s = 0.0;
  double wind_south_m_s = 0.0;
  double calm_m_s = 1.0;  ///< above 0: a wind much below it has no side
  double floor = 0.4;     ///< above 0: no distance is smaller
  std::span<const float> place_x;
  std::span<const float> place_z;

  std::span<float> distance;

  enum class Problem : std::uint8_t {
    kNone,
    kWindNotFinite,  ///< or so strong (1e154 m/s) that its square is not
    kCalmSpeed,      ///< not a number above 0, or its square is 0
    kFloor,          ///< not a finite number above 0
    kSizesDiffer,
  };
  [[nodiscard]] Problem validate() const noexcept;

  /// Runs the job unless validate() finds a problem; returns the result of validate().
  Problem run() const noexcept;
};

}  // namespace yuragi::operators
