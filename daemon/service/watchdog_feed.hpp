#pragma once

#include <cstdint>

#include "engine/base/time.hpp"

namespace yuragi::daemon::service {

/// Decides when a service manager's watchdog is fed: at most every quarter of its time-out, and only when both the I/O
/// thread and the animation have completed a round since it was last fed. Other parts that hang (a disk, a device) are
/// shown in the stream, and do not stop the feeding. Pure; for one thread.
class WatchdogFeed {
 public:
  /// `timeout`: the service manager restarts a program that has not fed its watchdog for this long. Without an
  /// animation only the I/O thread is watched.
  WatchdogFeed(Nanoseconds timeout, bool with_animation) : interval_(timeout / 4), with_animation_(with_animation) {}

  /// Call when the I/O thread has completed a round.
  void io_went_round() { io_has_ = true; }

  /// How many ticks the animation has made until now.
  void animation_has_made(std::uint64_t ticks) {
    animation_has_ = animation_has_ || ticks != ticks_;
    ticks_ = ticks;
  }

  /// Returns true if it is to be fed at `now`; then both have to go round again.
  bool take(MonoTime now) {
    if (!io_has_ || (with_animation_ && !animation_has_)) return false;
    if (has_fed_ && now - fed_ < interval_) return false;
    has_fed_ = true;
    fed_ = now;
    io_has_ = animation_has_ = false;
    return true;
  }

 private:
  Nanoseconds interval_;
  bool with_animation_;
  bool io_has_ = false, animation_has_ = false, has_fed_ = false;
  std::uint64_t ticks_ = 0;
  MonoTime fed_{};
};

}  // namespace yuragi::daemon::service
