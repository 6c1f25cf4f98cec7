#pragma once

#include <algorithm>
#include <cstdint>

#include "engine/base/time.hpp"

namespace yuragi::daemon::animation {

/// The length of a step that makes up for this many periods, so that motion keeps its speed: after a halt of the
/// machine, however long it was, at most kMaxStep_s.
inline constexpr double kMaxStep_s = 0.1;
inline double step_s(std::uint64_t periods, double rate_hz) noexcept {
  return std::min(static_cast<double>(periods) / rate_hz, kMaxStep_s);
}

/// The schedule of the animation's ticks: at begin + n * period. A loop that is late skips the ticks that it missed and
/// counts them; it never catches up.
///
/// Pure: time is a parameter. Thread-safe: no. Realtime-safe: yes.
class TickSchedule {
 public:
  struct Tick {
    std::uint64_t number = 0;   ///< from 0; skipped ticks leave gaps
    std::uint64_t skipped = 0;  ///< ticks skipped just before this one
    Nanoseconds lateness{};     ///< how long after its deadline the tick begins
  };

  TickSchedule(MonoTime begin, double rate_hz) : begin_(begin), period_(from_seconds(1.0 / rate_hz)) {}

  Nanoseconds period() const noexcept { return period_; }

  /// The deadline to wait for.
  MonoTime next_deadline() const noexcept { return begin_ + static_cast<Nanoseconds::rep>(next_) * period_; }

  /// Begins a tick at `now`, which is next_deadline() or later. If whole periods have passed since, their ticks are
  /// skipped, and this is the tick of the latest deadline.
  Tick begin_tick(MonoTime now) noexcept {
    const Nanoseconds since = now - next_deadline();
    const std::uint64_t skipped = since > Nanoseconds::zero() ? static_cast<std::uint64_t>(since / period_) : 0;
    const std::uint64_t number = next_ + skipped;
    next_ = number + 1;
    return {number, skipped, now - (begin_ + static_cast<Nanoseconds::rep>(number) * period_)};
  }

 private:
  MonoTime begin_;
  Nanoseconds period_;
  std::uint64_t next_ = 0;
};

}  // namespace yuragi::daemon::animation
