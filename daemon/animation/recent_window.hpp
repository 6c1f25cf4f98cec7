#pragma once

#include <array>
#include <cstddef>

#include "engine/base/time.hpp"

namespace yuragi::daemon::animation {

/// The value of a growing total at the beginning of the last 10 minutes; the difference from now is the increase since.
/// The window's length is between 9 and 10 minutes, or the whole time if that is shorter. `Total` is copied once a
/// minute. Time is a parameter. Thread-safe: no. Realtime-safe: yes.
template <class Total>
class RecentWindow {
 public:
  static constexpr std::size_t kSteps = 10;
  static constexpr Nanoseconds kStep = std::chrono::minutes(1);

  /// Call it at least once a minute. Returns the total at the beginning of the window; that of its first call is
  /// Total().
  const Total& begin_at(MonoTime now, const Total& total) noexcept {
    if (count_ == 0 || now - taken_ >= kStep) {
      totals_[count_ % kSteps] = count_ == 0 ? Total() : total;
      ++count_;
      taken_ = now;
    }
    return totals_[count_ < kSteps ? 0 : count_ % kSteps];
  }

 private:
  std::array<Total, kSteps> totals_{};
  std::size_t count_ = 0;  ///< of totals that were taken
  MonoTime taken_{};
};

}  // namespace yuragi::daemon::animation
