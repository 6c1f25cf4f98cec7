#pragma once

#include <algorithm>

namespace yuragi {

/// How much of a scene is seen: an opacity from 0 (hidden) to 1, and its way from the one to the other: a smooth step
/// (3 s^2 - 2 s^3), which begins and ends at rest. A fade that is turned round midway goes on from where it is.
///
/// Thread-safe: no. Realtime-safe: yes.
class Fade {
 public:
  explicit Fade(bool shown) noexcept : from_(shown ? 1.0 : 0.0), to_(from_) {}

  /// Goes to shown or hidden in over_s, which is at least 0.
  void begin(bool shown, double over_s) noexcept {
    from_ = value();
    to_ = shown ? 1.0 : 0.0;
    over_s_ = over_s;
    since_s_ = 0.0;
  }

  void advance(double dt_s) noexcept { since_s_ = std::min(since_s_ + dt_s, over_s_); }

  float opacity() const noexcept { return static_cast<float>(value()); }

 private:
  double value() const noexcept {
    if (since_s_ >= over_s_) return to_;
    const double share = since_s_ / over_s_;
    return from_ + (to_ - from_) * share * share * (3.0 - 2.0 * share);
  }

  double from_, to_;
  double over_s_ = 0.0, since_s_ = 0.0;
};

}  // namespace yuragi
