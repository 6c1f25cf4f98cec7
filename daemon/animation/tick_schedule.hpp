#pragma once

#include <cstdint>

#include "engine/base/time.hpp"

namespace yuragi {

/// When the animation ticks: at fixed moments, begin + n * period, whatever happens in between. A loop that comes late
/// skips the moments that have passed, counts them, and goes on at the next; it never runs after them (no spiral).
///
/// Pure: time is a parameter. Thread-safe: no. Realtime-safe: yes.
class TickSchedule {
 public:
  struct Tick {
    std::uint64_t number = 0;   ///< of the moment, from 0; skipped moments leave gaps
    std::uint64_t skipped = 0;  ///< moments that passed unused just before this one
    Nanoseconds lateness{};     ///< how long after its moment the tick begins
  };

  TickSchedule(MonoTime begin, double rate_hz) : begin_(begin), period_(from_seconds(1.0 / rate_hz)) {}

  Nanoseconds period() const noexcept { return period_; }

  /// The moment to wait for.
  MonoTime next_deadline() const noexcept { return begin_ + static_cast<Nanoseconds::rep>(next_) * period_; }

  /// Begins a tick at `now`, which is next_deadline() or later. When whole periods have passed since, their moments are
  /// skipped, and the tick is that of the latest moment.
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

}  // namespace yuragi
