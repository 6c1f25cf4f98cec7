#pragma once

#include <optional>

#include "engine/base/time.hpp"

namespace yuragi::drivers::hid {

/// When a console does something that it does at regular intervals, learned from outside: by reads that find that it
/// has happened since the read before. The result is an interval of time, narrowed by every further read. Two clocks
/// drift apart: its owner resets it from time to time. Thread-safe: no. Realtime-safe: yes.
class WriteClock {
 public:
  /// `period`: from one time to the next. `margin`: how far to keep away, before and after.
  WriteClock(Nanoseconds period, Nanoseconds margin) : period_(period), margin_(margin) {}

  /// It happened after `from` and not later than `to`. Reads that are a period or more apart carry no information:
  /// false.
  bool happened_between(MonoTime from, MonoTime to);

  void forget() { window_.reset(); }
  /// Returns true if the moment is known to at least a third of the period. Otherwise no time would be left outside of
  /// it.
  bool is_known() const { return window_ && window_->to - window_->from <= period_ / 3; }

  /// The first time from `time` on that is not near the moment; `time` itself while the moment is unknown.
  MonoTime clear_from(MonoTime time) const;
  /// The first time from `time` on at which it has just happened and is no longer near; `time` while it is unknown.
  MonoTime behind(MonoTime time) const;

 private:
  /// The moment lies in here, and a whole number of periods later again.
  struct Window {
    MonoTime from;
    MonoTime to;
  };
  /// The window of the last period that began at `time` or before.
  Window window_before(MonoTime time) const;

  Nanoseconds period_;
  Nanoseconds margin_;
  std::optional<Window> window_;
};

}  // namespace yuragi::drivers::hid
