#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "engine/base/time.hpp"

namespace yuragi {

/// Decides which changes of a value go into the log, so that it stays readable for months: a change must have held for
/// a while. The first change is told at once, the next after 1 s, and each doubles what the next must hold, up to
/// 10 min; each quiet hour halves it again. What flaps faster than that is told a few times an hour, and counted.
/// Thread-safe: no. Realtime-safe: yes.
class ChangeGate {
 public:
  /// `reported`: what needs no telling, since it is so at the beginning.
  explicit ChangeGate(std::uint32_t reported) : reported_(reported), seen_(reported) {}

  /// The value as of now; answers whether it is to be told.
  bool offer(std::uint32_t value, MonoTime now) noexcept {
    if (value != seen_) {
      if (seen_ != reported_) ++passed_over_;
      seen_ = value;
      seen_since_ = now;
    }
    if (value == reported_ || seconds(now - seen_since_) < needed_s(now)) return false;
    hold_s_ = std::clamp(2.0 * needed_s(now), kShortestHold_s, kLongestHold_s);
    reported_ = value;
    reported_at_ = now;
    reported_passed_over_ = passed_over_;
    passed_over_ = 0;
    return true;
  }

  /// How many changes before the one that was just told were not.
  std::uint64_t passed_over() const noexcept { return reported_passed_over_; }

  /// What was told last.
  std::uint32_t reported() const noexcept { return reported_; }

 private:
  static constexpr double kShortestHold_s = 1.0;
  static constexpr double kLongestHold_s = 600.0;
  static constexpr double kQuiet_s = 3600.0;

  double needed_s(MonoTime now) const noexcept {
    return hold_s_ * std::exp2(-std::floor(std::max(0.0, seconds(now - reported_at_) / kQuiet_s)));
  }

  std::uint32_t reported_;
  std::uint32_t seen_;
  MonoTime seen_since_{};
  MonoTime reported_at_{};
  double hold_s_ = 0.0;
  std::uint64_t passed_over_ = 0;
  std::uint64_t reported_passed_over_ = 0;
};

}  // namespace yuragi
