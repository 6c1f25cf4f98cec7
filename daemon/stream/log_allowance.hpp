#pragma once

#include <algorithm>
#include <cstdint>

#include "engine/base/time.hpp"

namespace yuragi::daemon::stream {

/// Limits the lines that clients cause in the log: a token bucket. `burst` lines at once, and `per_s` in the long run;
/// omitted lines are counted. Pure: time is a parameter. Thread-safe: no. Realtime-safe: yes.
class LogAllowance {
 public:
  struct Settings {
    double burst = 60.0;  ///< lines
    double per_s = 1.0;   ///< lines per second
    Nanoseconds report_every = std::chrono::seconds(10);
  };

  LogAllowance(const Settings& settings, MonoTime now)
      : settings_(settings), tokens_(settings.burst), filled_(now), reported_(now) {}

  /// Returns true if a line may be written at `now`; otherwise counts it.
  bool take(MonoTime now) noexcept {
    tokens_ = std::min(settings_.burst, tokens_ + settings_.per_s * seconds(now - filled_));
    filled_ = now;
    if (tokens_ < 1.0) {
      ++left_out_;
      return false;
    }
    tokens_ -= 1.0;
    return true;
  }

  /// Returns how many lines were omitted since the last report; 0 if none, or if that was less than report_every ago.
  std::uint64_t take_left_out(MonoTime now) noexcept {
    if (left_out_ == 0 || now - reported_ < settings_.report_every) return 0;
    reported_ = now;
    const std::uint64_t count = left_out_;
    left_out_ = 0;
    return count;
  }

 private:
  Settings settings_;
  double tokens_;
  MonoTime filled_, reported_;
  std::uint64_t left_out_ = 0;
};

}  // namespace yuragi::daemon::stream
