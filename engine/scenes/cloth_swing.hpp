#pragma once

#include <algorithm>
#include <cmath>

#include "engine/base/units.hpp"

namespace yuragi::scenes {

/// A damped oscillator whose frequency and damping may change while it swings: q'' + c q' + w^2 (q - target) = 0,
/// stepped by the implicit midpoint rule, which is stable for any step and takes no energy of its own from the swing.
/// No library function, so the same bits on every machine.
///
/// Neither how far it is from 0 nor how fast it goes ever exceeds the limits that it is given, so that it cannot be
/// driven beyond them by a frequency that changes with its swing. What has come closer to 0 than 1e-6 while its target
/// is 0 comes to rest there. Thread-safe: no; one owner. Realtime-safe: yes.
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

  /// The same for what has no value but only a way to its target (a direction): steps the rate and returns its mean
  /// during dt_s, which is within the limit as well.
  double pull(double way, double natural_hz, double damping_per_s, double largest_rate_per_s, double dt_s) noexcept {
    const double before_per_s = rate_per_s;
    const double w = 2.0 * kPi * natural_hz;
    const double lost = 0.5 * damping_per_s * dt_s + 0.25 * w * w * dt_s * dt_s;
    const double now_per_s = ((1.0 - lost) * before_per_s + w * w * dt_s * way) / (1.0 + lost);
    rate_per_s = std::clamp(now_per_s, -largest_rate_per_s, largest_rate_per_s);
    return 0.5 * (before_per_s + rate_per_s);
  }

  static constexpr double kAtRest = 1e-6;
};

}  // namespace yuragi::scenes
