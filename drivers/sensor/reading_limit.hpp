#pragma once

#include <algorithm>
#include <cstdint>

#include "engine/base/time.hpp"

namespace yuragi::drivers::sensor {

/// Limits the readings of a source to which anybody in a network can send: 100 a second over any length of time, and at
/// most one second's more at once. No wind needs more, and a flood can fill neither the rings nor a recording.
///
/// A token bucket as a meter (ITU-T I.371, "Traffic control and congestion control in B-ISDN", 2004, annex A: virtual
/// scheduling). Thread-safe: no. Realtime-safe: yes.
class ReadingLimit {
 public:
  static constexpr std::int64_t kReadingsPerSecond = 100;

  /// Returns true if another reading can be published now, and counts it.
  bool admits(MonoTime now) noexcept {
    paid_until_ = std::max(paid_until_, now);
    if (paid_until_ - now > kBurst - kInterval) return false;
    paid_until_ += kInterval;
    return true;
  }

 private:
  static constexpr Nanoseconds kBurst = std::chrono::seconds(1);
  static constexpr Nanoseconds kInterval = kBurst / kReadingsPerSecond;

  MonoTime paid_until_{};
};

}  // namespace yuragi::drivers::sensor
