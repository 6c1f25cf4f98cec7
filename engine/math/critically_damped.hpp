#pragma once

#include <cmath>

namespace yuragi::math {

/// A value that follows a target as fast as it can without overshooting a target at rest: the critically damped
/// oscillator q'' + 2 w q' + w^2 (q - target) = 0, stepped exactly.
///
/// The step is the closed-form solution for a target that is constant during it, so it is unconditionally stable, a
/// long step has the result of many short ones, and value and rate are continuous even if the target jumps. From rest,
/// a target that steps by e moves the value by at most e w / exp(1) (0.37 e w) per second. Units: the value's own, and
/// per second. Finite for finite input (numbers up to 1e100). Thread-safe: no; one owner. Realtime-safe: yes.
struct CriticallyDamped {
  double value = 0.0;
  double rate_per_s = 0.0;

  /// Advances by dt_s toward `target`. A larger omega_rad_s (at least 0) follows faster: after 4.75 / omega_rad_s, 95 %
  /// of a step is done. A dt_s of 0 or less changes nothing.
  void step(double target, double omega_rad_s, double dt_s) noexcept {
    if (!(dt_s > 0.0)) return;
    const double phase = omega_rad_s * dt_s;

    // Far beyond the decay the products below would be infinity times zero: the value has arrived.
    if (phase > kArrived) {
      value = target;
      rate_per_s = 0.0;
      return;
    }

    // With d = q - target: d(t) = (d + (q' + w d) t) exp(-w t), and its derivative.
    const double decay = std::exp(-phase);
    const double distance = value - target;
    const double rate = rate_per_s;
    value = target + decay * ((1.0 + phase) * distance + rate * dt_s);
    rate_per_s = decay * ((1.0 - phase) * rate - omega_rad_s * phase * distance);
  }

  /// StatePass's.
  template <class Pass>
  void list_state(Pass& pass) {
    pass(value, rate_per_s);
  }

 private:
  /// exp(-700) is 1e-304: the remaining distance is negligible.
  static constexpr double kArrived = 700.0;
};

}  // namespace yuragi::math
