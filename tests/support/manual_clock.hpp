#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <list>
#include <mutex>
#include <vector>

#include "drivers/sensor/clock.hpp"

namespace yuragi {

/// The tests' clock: it stands still until the test moves it. One thread moves it; any may read it and wait by it.
class ManualClock final : public drivers::sensor::Clock {
 public:
  Instant now() const noexcept override {
    return {.mono = MonoTime(Nanoseconds(mono_ns_)), .utc = UtcTime(Nanoseconds(utc_ns_))};
  }

  void advance(Nanoseconds by) {
    mono_ns_ += by.count();
    utc_ns_ += by.count();
    std::vector<Waiter> waiters;
    {
      const std::lock_guard lock(mutex_);
      waiters.assign(waiters_.begin(), waiters_.end());
    }
    for (const Waiter& waiter : waiters) {
      { const std::lock_guard before_or_in_its_wait(*waiter.mutex); }
      waiter.changed->notify_all();
    }
  }
  void advance_to(MonoTime moment) {
    if (moment > now().mono) advance(moment - now().mono);
  }
  /// The machine's clock is set: no time passes.
  void set_utc(UtcTime utc) { utc_ns_ = utc.time_since_epoch().count(); }

  void wait_until(MonoTime moment, std::unique_lock<std::mutex>& lock, std::condition_variable_any& changed,
                  const std::stop_token& stop, const std::function<bool()>& is_woken) const override {
    std::list<Waiter>::iterator waiter;
    {
      const std::lock_guard guard(mutex_);
      waiter = waiters_.insert(waiters_.end(), {moment, lock.mutex(), &changed});
    }
    waits_.notify_all();
    changed.wait(lock, stop, [&] { return now().mono >= moment || is_woken(); });
    const std::lock_guard guard(mutex_);
    waiters_.erase(waiter);
  }

  /// Waits until so many threads wait by this clock, and for a later moment than now: all that was to be done by now is
  /// done. False if they hang.
  bool wait_for_waiters(std::size_t threads) const {
    std::unique_lock lock(mutex_);
    return waits_.wait_for(lock, std::chrono::seconds(60), [&] {
      return waiters_.size() == threads &&
             std::ranges::all_of(waiters_, [this](const Waiter& waiter) { return waiter.moment > now().mono; });
    });
  }

 private:
  struct Waiter {
    MonoTime moment;
    std::mutex* mutex;
    std::condition_variable_any* changed;
  };

  /// Neither begins at zero, so that a time that was never set is seen.
  std::atomic<Nanoseconds::rep> mono_ns_ = Nanoseconds(std::chrono::hours(1)).count();
  std::atomic<Nanoseconds::rep> utc_ns_ =
      Nanoseconds(std::chrono::sys_days(std::chrono::year(2024) / 6 / 1).time_since_epoch()).count();

  mutable std::mutex mutex_;
  mutable std::condition_variable waits_;
  mutable std::list<Waiter> waiters_;
};

}  // namespace yuragi
