#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/base/state_pass.hpp"
#include "engine/math/critically_damped.hpp"

namespace yuragi::scenes {

/// The strength of a cloth's flutter, 0 to 1: u^2 / (u^2 + half^2) for the wind u, which grows with the square of a
/// weak wind and never reaches 1; a quarter of a second late (2 / omega), because waves need some time to grow.
///
/// From one tick of dt to the next it changes by at most largest_step(dt), in any wind: it follows a target that stays
/// between 0 and 1, so that its rate never exceeds 2 w / e (CriticallyDamped's impulse response, see Wind). Calm
/// from the beginning stays 0, and values below 1e-9 become 0. Thread-safe: no; one owner. Realtime-safe: yes.
class ClothStrength {
 public:
  void step(double wind_m_s, double half_m_s, double dt_s) noexcept {
    const double square = wind_m_s * wind_m_s;
    follower_.step(square / (square + half_m_s * half_m_s), kOmega_rad_s, dt_s);
    if (!(square > 0.0) && std::abs(follower_.value) < kAtRest && std::abs(follower_.rate_per_s) < kAtRest) {
      follower_ = {};
    }
  }

  double value() const noexcept { return follower_.value; }

  static double largest_step(double dt_s) noexcept {
    return std::min(2.0 * kOmega_rad_s / std::numbers::e * dt_s, 1.0);
  }

  void list_state(StatePass& pass) { pass(follower_); }

 private:
  static constexpr double kOmega_rad_s = 8.0;
  static constexpr double kAtRest = 1e-9;

  math::CriticallyDamped follower_;
};

}  // namespace yuragi::scenes
