#pragma once

#include <cstdint>

#include "engine/base/state_pass.hpp"
#include "engine/noise/noise_tile.hpp"

namespace yuragi::noise {

// Places on the torus that a noise tile covers, in fixed point: 2^32 is one period, so that wrapping costs nothing, is
// exact, and a place is as fine after a year as at the start (256 m / 2^32 = 60 nm). A field that has moved by X is
// read at x - X (Chiba, section 2-2; engine/METHOD.md M9, D2).

/// A place on a torus: x toward east, z toward south. Arithmetic wraps.
struct TorusPhase {
  std::uint32_t x = 0;
  std::uint32_t z = 0;

  friend TorusPhase operator-(TorusPhase a, TorusPhase b) { return {a.x - b.x, a.z - b.z}; }
  friend bool operator==(const TorusPhase&, const TorusPhase&) = default;
};

/// The phase of a position on an axis of period `period_m` (above 0), to the nearest 2^-32 of it; whole periods drop
/// out exactly, and torus_phase(-x) is -torus_phase(x). Finite positions. Thread-safe and realtime-safe: yes.
std::uint32_t torus_phase(double position_m, double period_m) noexcept;

/// How far something has moved along one axis of a torus: the integral of its velocity.
///
/// Each step is rounded to a phase, and the remainder is added to the next step: after any number of steps the phase is
/// that of their sum to about one part in 2^32 of the period, and never drifts. Thread-safe: no. Realtime-safe: yes.
class TorusTravel {
 public:
  /// Moves on by `distance_m` (finite) on an axis of period `period_m` (above 0).
  void add(double distance_m, double period_m) noexcept;

  std::uint32_t phase() const noexcept { return phase_; }

  void list_state(StatePass& pass) {
    pass(phase_);
    pass.within(remainder_, -0.5, 0.5);
  }

 private:
  std::uint32_t phase_ = 0;
  double remainder_ = 0.0;  ///< in units of the phase, at most 0.5 in either direction
};

/// How far a field has moved on its torus: the shifting operator's f(n).
struct TorusOffset {
  TorusTravel x;  ///< toward east
  TorusTravel z;  ///< toward south

  TorusPhase phase() const noexcept { return {x.phase(), z.phase()}; }
  void list_state(StatePass& pass) { pass(x, z); }
};

/// May this tile be read? Its size is a power of two, 2 to 2^16, and it has all its values.
bool is_readable(const Tile1& tile) noexcept;
bool is_readable(const Tile2& tile) noexcept;

/// The noise at a place, linear (bilinear) between samples; sample (0, 0) is at phase 0, and the last is followed by
/// the first. The tile is_readable(). Thread-safe and realtime-safe: yes. SampleJob (engine/operators) reads many
/// places at once, to the same bits.
float read_noise(const Tile1& tile, std::uint32_t at) noexcept;
float read_noise(const Tile2& tile, TorusPhase at) noexcept;

}  // namespace yuragi::noise
