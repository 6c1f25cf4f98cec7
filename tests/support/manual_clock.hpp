#pragma once

#include "drivers/sensor/clock.hpp"

namespace yuragi {

/// A clock that stands still until the test moves it.
class ManualClock final : public Clock {
 public:
  Instant now() const noexcept override { return now_; }

  void advance(Nanoseconds by) {
    now_.mono += by;
    now_.utc += by;
  }
  void advance_to(MonoTime moment) {
    if (moment > now_.mono) advance(moment - now_.mono);
  }
  /// The machine's clock is set: no time passes.
  void set_utc(UtcTime utc) { now_.utc = utc; }

 private:
  /// Neither zero, so that a time that was never set is seen.
  Instant now_{MonoTime(std::chrono::hours(1)), UtcTime(std::chrono::sys_days(std::chrono::year(2024) / 6 / 1))};
};

}  // namespace yuragi
