#pragma once

#include "engine/base/time.hpp"

namespace yuragi::workers {

/// Whether threads are to share work that comes again and again, a tick at a time, or one is to do it alone: whichever
/// took less time. Where another program holds the other cores, a thread that has begun a part and waits for its core
/// holds the tick up.
///
/// It tries the other way for kTrialTicks of each kCycleTicks and then keeps the one whose mean is smaller, so that
/// a trial of the slower way costs less than a hundredth of the difference, and slows fewer than one tick in a hundred.
/// It begins alone, with a trial after kTrialTicks. The choice changes no result (Pool). Thread-safe: no.
/// Realtime-safe: yes.
class SharingChoice {
 public:
  static constexpr int kTrialTicks = 8;
  static constexpr int kCycleTicks = 1024;  ///< 17 s at 60 Hz

  /// Is the next tick shared?
  bool is_shared() const noexcept { return is_shared_ != is_trial_; }

  /// How long the tick took, done as is_shared() said.
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
  static constexpr int kKeptTicks = 64;  // before a trial, which it is compared with

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
