#pragma once

#include <algorithm>

#include "engine/base/time.hpp"

namespace yuragi::daemon::stream {

/// Selects the frames of a client with a maximum rate. The rate is exact in the long run even if it does not divide
/// that of the frames; after a pause at most one frame is sent in addition. Pure: time is a parameter. Thread-safe: no.
class FramePace {
 public:
  /// `rate_hz`: above 0.
  FramePace(double rate_hz, MonoTime now) : every_(from_seconds(std::min(1.0 / rate_hz, kLongest_s))), due_(now) {}

  /// Returns true if a frame is due at `now`; then the next one has to wait.
  bool take(MonoTime now) noexcept {
    if (now < due_) return false;
    due_ = std::max(due_ + every_, now);
    return true;
  }

 private:
  static constexpr double kLongest_s = 3600.0;

  Nanoseconds every_;
  MonoTime due_;
};

}  // namespace yuragi::daemon::stream
