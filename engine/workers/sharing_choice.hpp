#pragma once

#include "engine/base/time.hpp"

namespace yuragi::workers {

/// Decides whether threads share the repeated work of ticks, or one does it alone: whichever took less time. If another
/// program uses the other cores, a thread that has begun a part and waits for its core delays the tick.
///
/// It tries the other way for kTrialTicks of each kCycleTicks and then keeps the one whose mean is smaller, so that a
/// trial of the slower way costs less than a hundredth of the difference, and slows fewer than one tick in a hundred.
/// It begins alone, with a trial after kTrialTicks. The choice changes no result (Pool). Thread-safe: no.
/// Realtime-safe: yes.
class SharingChoice {
 public:
  static constexpr int kTrialTicks = 8;
  static constexpr int kCycleTicks = 1024;  ///< 17 s at 60 Hz

  /// Returns true if the next tick is shared.
  bool is_shared() const noexcept { return is_shared_ != is_trial_; }

  /// Takes the duration of a tick, done according to is_shared().
  void took(Nanoseconds duration) noexcept {
    sum_ += duration;
    ++ticks_;
    if (--ticks_left_ == kKeptTicks) begin_sum();
    if (ticks_left_ > 0) return;
    const Nanoseconds mean = sum_ / ticks_;
    if (is_trial_ && mean < kept_mean_) is_shared_ = !is_shared_;
    kept_mean_ = mean;
    ticks_left_ = is_trial_ ? kCycleTicks - kTrialTicks : kTrialTicks;
    is_trial_ = !is_trial_;
    begin_sum();
  }

 private:
  static constexpr int kKeptTicks = 64;  // before a trial, for comparison

  void begin_sum() noexcept {
    sum_ = Nanoseconds{0};
    ticks_ = 0;
  }

  bool is_shared_ = false;  // outside of trials
  bool is_trial_ = false;
  int ticks_left_ = kTrialTicks;  // of the trial, or until the next one
  int ticks_ = 0;                 // that sum_ is of
  Nanoseconds sum_{0};
  Nanoseconds kept_mean_{0};
};

}  // namespace yuragi::workers
