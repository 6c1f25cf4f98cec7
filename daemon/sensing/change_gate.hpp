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
  /// `told`: what needs no telling, since it is so at the beginning.
  explicit ChangeGate(std::uint32_t told) : told_(told), seen_(told) {}

  /// The value as of now; answers whether it is to be told.
  bool offer(std::uint32_t value, MonoTime now) noexcept {
    if (value != seen_) {
      if (seen_ != told_) ++passed_over_;
      seen_ = value;
      seen_since_ = now;
    }
    if (value == told_ || seconds(now - seen_since_) < needed_s(now)) return false;
    hold_s_ = std::clamp(2.0 * needed_s(now), kShortestHold_s, kLongestHold_s);
    told_ = value;
    told_at_ = now;
    told_passed_over_ = passed_over_;
    passed_over_ = 0;
    return true;
  }

  /// How many changes before the one that was just told were not.
  std::uint64_t passed_over() const noexcept { return told_passed_over_; }

  /// What was told last.
  std::uint32_t told() const noexcept { return told_; }

 private:
  static constexpr double kShortestHold_s = 1.0;
  static constexpr double kLongestHold_s = 600.0;
  static constexpr double kQuiet_s = 3600.0;

  double needed_s(MonoTime now) const noexcept {
    return hold_s_ * std::exp2(-std::floor(std::max(0.0, seconds(now - told_at_) / kQuiet_s)));
  }

  std::uint32_t told_;
  std::uint32_t seen_;
  MonoTime seen_since_{};
  MonoTime told_at_{};
  double hold_s_ = 0.0;
  std::uint64_t passed_over_ = 0;
  std::uint64_t told_passed_over_ = 0;
};

}  // namespace yuragi
