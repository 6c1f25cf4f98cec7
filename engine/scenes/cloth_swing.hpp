#pragma once

#include <algorithm>
#include <cmath>

#include "engine/base/state_pass.hpp"
#include "engine/base/units.hpp"

namespace yuragi::scenes {

/// A damped oscillator whose frequency and damping may change while it swings: q'' + c q' + w^2 (q - target) = 0,
/// stepped by the implicit midpoint rule, which is stable for any step and adds no damping. No library function, so the
/// same bits on every machine.
///
/// Neither its value nor its rate exceeds the given limits, so that a frequency that changes with its swing cannot
/// drive it beyond them. Below 1e-6 with a target of 0 it comes to rest. Thread-safe: no; one owner. Realtime-safe:
/// yes.
struct ClothSwing {
  double value = 0.0;
  double rate_per_s = 0.0;

  struct Limits {
    double value = 1.0;       ///< above 0
    double rate_per_s = 1.0;  ///< above 0
  };

  /// Advances by dt_s (above 0). `target` within limits.value; natural_hz at least 0; damping_per_s: c, at least 0.
  void step(double target, double natural_hz, double damping_per_s, Limits limits, double dt_s) noexcept {
    if (target == 0.0 && std::abs(value) < kAtRest && std::abs(rate_per_s) < kAtRest) {
      *this = {};
      return;
    }
    const double mean_rate_per_s = pull(target - value, natural_hz, damping_per_s, limits.rate_per_s, dt_s);
    value = std::clamp(value + dt_s * mean_rate_per_s, -limits.value, limits.value);
  }

  /// The same for a quantity that has no value but only a distance to its target (a direction): steps the rate and
  /// returns its mean during dt_s, which is also within the limit.
  double pull(double way, double natural_hz, double damping_per_s, double largest_rate_per_s, double dt_s) noexcept {
    const double before_per_s = rate_per_s;
    const double w = 2.0 * kPi * natural_hz;
    const double lost = 0.5 * damping_per_s * dt_s + 0.25 * w * w * dt_s * dt_s;
    const double now_per_s = ((1.0 - lost) * before_per_s + w * w * dt_s * way) / (1.0 + lost);
    rate_per_s = std::clamp(now_per_s, -largest_rate_per_s, largest_rate_per_s);
    return 0.5 * (before_per_s + rate_per_s);
  }

  void list_state(StatePass& pass) { pass(value, rate_per_s); }

  static constexpr double kAtRest = 1e-6;
};

}  // namespace yuragi::scenes
