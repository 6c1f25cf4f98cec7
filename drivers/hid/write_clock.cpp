#include "drivers/hid/write_clock.hpp"

#include <algorithm>

namespace yuragi::drivers::hid {

bool WriteClock::happened_between(MonoTime from, MonoTime to) {
  if (to <= from || to - from >= period_) return false;
  const Window seen = {from, to};
  window_ = window_ ? window_before(to) : seen;

  // The intersection. If it is empty, the console's clock was set, or has drifted: only the new window holds.
  for (const Nanoseconds shift : {Nanoseconds::zero(), period_}) {
    const Window common = {std::max(window_->from + shift, seen.from), std::min(window_->to + shift, seen.to)};
    if (common.from < common.to) {
      window_ = common;
      return true;
    }
  }
  window_ = seen;
  return true;
}

WriteClock::Window WriteClock::window_before(MonoTime time) const {
  // Rounded down even if the window lies ahead.
  Nanoseconds since = time - window_->from;
  std::int64_t periods = since / period_;
  if (since < Nanoseconds::zero() && since % period_ != Nanoseconds::zero()) --periods;
  return {window_->from + periods * period_, window_->to + periods * period_};
}

MonoTime WriteClock::clear_from(MonoTime time) const {
  if (!is_known()) return time;
  // Of the two windows that could be near, the later one begins after `time`.
  const Window before = window_before(time + margin_);
  return time < before.to + margin_ ? before.to + margin_ : time;
}

MonoTime WriteClock::behind(MonoTime time) const {
  if (!is_known()) return time;
  const Window before = window_before(time - margin_);
  const MonoTime clear = before.to + margin_;
  return clear >= time ? clear : clear + period_;
}

}  // namespace yuragi::drivers::hid
