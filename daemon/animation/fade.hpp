#pragma once

#include <algorithm>

#include "engine/base/state_pass.hpp"

namespace yuragi::daemon::animation {

/// The opacity of a scene, from 0 (hidden) to 1, and its fade between them: the smooth step 3 s^2 - 2 s^3, whose rate
/// is 0 at both ends. A fade that is reversed midway continues from its present opacity.
///
/// Thread-safe: no. Realtime-safe: yes.
class Fade {
 public:
  explicit Fade(bool shown) noexcept : from_(shown ? 1.0 : 0.0), to_(from_) {}

  /// Begins a fade to shown or hidden that takes over_s, at least 0.
  void begin(bool shown, double over_s) noexcept {
    from_ = value();
    to_ = shown ? 1.0 : 0.0;
    over_s_ = over_s;
    since_s_ = 0.0;
  }

  void advance(double dt_s) noexcept { since_s_ = std::min(since_s_ + dt_s, over_s_); }

  /// Returns true if it is shown, or fading in.
  bool is_shown() const noexcept { return to_ > 0.5; }

  float opacity() const noexcept { return static_cast<float>(value()); }

  void list_state(StatePass& pass) {
    for (double* part : {&from_, &to_}) pass.within(*part, 0.0, 1.0);
    for (double* time_s : {&over_s_, &since_s_}) pass.within(*time_s, 0.0, StatePass::kLargest);
  }

 private:
  double value() const noexcept {
    if (since_s_ >= over_s_) return to_;
    const double share = since_s_ / over_s_;
    return from_ + (to_ - from_) * share * share * (3.0 - 2.0 * share);
  }

  double from_, to_;
  double over_s_ = 0.0, since_s_ = 0.0;
};

}  // namespace yuragi::daemon::animation
