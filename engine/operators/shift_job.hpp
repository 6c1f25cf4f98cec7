#pragma once

#include <cstdint>

#include "engine/noise/torus.hpp"

namespace yuragi::operators {

/// The shifting operator: the wind carries its turbulence along (Taylor's frozen turbulence), offset += wind dt.
///
/// An integral, never wind times time, so that a new reading bends the path and the field never jumps (Chiba, section
/// 2-2 (1); engine/METHOD.md M9, D2); and the field itself is never turned, because turning a tile would sweep far
/// places sideways (D3). The offset moves downwind: x east, z south. Metres, seconds. Owns nothing. Thread-safe:
/// different offsets, yes. Realtime-safe: yes.
struct ShiftJob {
  double wind_east_m_s = 0.0;
  double wind_south_m_s = 0.0;
  double dt_s = 0.0;
  double period_m = 0.0;  ///< of the tile that is shifted

  noise::TorusOffset* offset = nullptr;

  enum class Problem : std::uint8_t {
    kNone,
    kNoOffset,
    kWindNotFinite,
    kStepNotPositive,    ///< dt_s is not a finite number above 0
    kPeriodNotPositive,  ///< period_m is not a finite number above 0
  };
  [[nodiscard]] Problem validate() const noexcept;

  /// Runs the job unless validate() finds a problem; returns the result of validate().
  Problem run() const noexcept;
};

}  // namespace yuragi::operators
