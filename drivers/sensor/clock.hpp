#pragma once

#include <algorithm>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <stop_token>

#include "engine/base/time.hpp"

namespace yuragi::drivers::sensor {

/// The time, and waiting until a time; tests substitute another. Thread-safe.
class Clock {
 public:
  virtual ~Clock() = default;
  virtual Instant now() const noexcept = 0;

  /// Waits until `moment` or a stop is requested, or until `changed` was notified and `is_woken` returns true. `lock`
  /// holds the mutex that guards `is_woken`. May return earlier, a second after its call, so that a clock that is set
  /// cannot put a thread to sleep for long.
  virtual void wait_until(MonoTime moment, std::unique_lock<std::mutex>& lock, std::condition_variable_any& changed,
                          const std::stop_token& stop, const std::function<bool()>& is_woken) const {
    const Nanoseconds wait = std::min<Nanoseconds>(moment - now().mono, std::chrono::seconds(1));
    if (wait > Nanoseconds::zero()) changed.wait_for(lock, stop, wait, is_woken);
  }
};

}  // namespace yuragi::drivers::sensor
