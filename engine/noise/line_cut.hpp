#pragma once

#include "engine/base/state_pass.hpp"
#include "engine/noise/torus.hpp"

namespace yuragi::noise {

/// A path over a torus along a line of golden slope, which makes a 1-D noise that never visibly repeats: read a 2-D
/// tile at the line's present place (Chiba, section 2-2 (2), figure 4a).
///
/// The line goes 0.851 east and 0.526 south a metre. When it returns in x for the n-th time it is at least 0.38 / n of
/// the period beside its old place in z, because the golden number is the farthest from all fractions: on a tile of 512
/// samples it first comes within a sample of itself after 233 times around, 274 periods of path. Fixed point: a step is
/// rounded to 2^-32 of the period and its rest kept, as TorusTravel does. Thread-safe: no. Realtime-safe: yes.
class LineCut {
 public:
  /// The line's direction: cos and sin of the angle whose tangent is 1 / phi.
  static constexpr double kEast = 0.85065080835203993;
  static constexpr double kSouth = 0.52573111211913361;

  /// Advances by `distance_m` (finite) along the line over a tile of period `period_m` (above 0).
  void add(double distance_m, double period_m) noexcept {
    x_.add(distance_m * kEast, period_m);
    z_.add(distance_m * kSouth, period_m);
  }

  /// The line's present place: read_noise(tile, cut.phase()).
  TorusPhase phase() const noexcept { return {x_.phase(), z_.phase()}; }

  /// The difference on the torus of two places of the line that are `distance_m` apart along it. The place of
  /// `distance_m` ago is phase() - apart(distance_m, period_m). Not for accumulating: each call rounds once.
  static TorusPhase apart(double distance_m, double period_m) noexcept {
    return {torus_phase(distance_m * kEast, period_m), torus_phase(distance_m * kSouth, period_m)};
  }

  void list_state(StatePass& pass) { pass(x_, z_); }

 private:
  TorusTravel x_, z_;
};

}  // namespace yuragi::noise
