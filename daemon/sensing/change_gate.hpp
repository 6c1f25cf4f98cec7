#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "engine/base/time.hpp"

namespace yuragi::daemon::sensing {

/// Decides which changes of a value are logged: a new value must have lasted for a minimum time. The first change is
/// reported at once, the second after 1 s; each report doubles the minimum for the next, up to 10 min, and each hour
/// without a report halves it. So a value that flaps is reported a few times an hour, with the number of changes left
/// out.
/// Thread-safe: no. Realtime-safe: yes.
class ChangeGate {
 public:
  /// `reported`: the initial value, which is not reported.
  explicit ChangeGate(std::uint32_t reported) : reported_(reported), seen_(reported) {}

  /// Takes the value at `now`; true if it is to be reported.
  bool offer(std::uint32_t value, MonoTime now) noexcept {
    if (value != seen_) {
      if (seen_ != reported_) ++passed_over_;
      seen_ = value;
      seen_since_ = now;
    }
    if (value == reported_ || seconds(now - seen_since_) < needed_s(now)) return false;
    hold_s_ = std::clamp(2.0 * needed_s(now), kMinHold_s, kMaxHold_s);
    reported_ = value;
    reported_at_ = now;
    reported_passed_over_ = passed_over_;
    passed_over_ = 0;
    return true;
  }

  /// How many changes were left out before the last report.
  std::uint64_t passed_over() const noexcept { return reported_passed_over_; }

  /// The value of the last report.
  std::uint32_t reported() const noexcept { return reported_; }

 private:
  static constexpr double kMinHold_s = 1.0;
  static constexpr double kMaxHold_s = 600.0;
  static constexpr double kQuiet_s = 3600.0;

  double needed_s(MonoTime now) const noexcept {
    return hold_s_ * std::exp2(-std::floor(std::max(0.0, seconds(now - reported_at_) / kQuiet_s)));
  }

  std::uint32_t reported_;
  std::uint32_t seen_;
  MonoTime seen_since_{};
  MonoTime reported_at_{};
  double hold_s_ = 0.0;
  std::uint64_t passed_over_ = 0;
  std::uint64_t reported_passed_over_ = 0;
};

}  // namespace yuragi::daemon::sensing
