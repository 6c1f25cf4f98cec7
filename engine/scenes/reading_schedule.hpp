#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "engine/base/state_pass.hpp"

namespace yuragi::scenes {

/// Decides which part of a grid is read at which tick, so that each part is read kReadings_hz times a second and each
/// tick costs the same.
///
/// A grid has as many parts as ticks fit between two readings of a part: 5 at 60 ticks a second. Part p of n is read at
/// the ticks whose number leaves p when divided by n, so that the schedule depends on the tick's number alone, not on
/// when the grid was made; the parts of skipped ticks are read at the next one. A part is read as it will be `lead_s`
/// later, and its values move there linearly (WindGrid).
///
/// Pure. Thread-safe: no. Realtime-safe: yes.
class ReadingSchedule {
 public:
  static constexpr double kReadings_hz = 12.0;
  static constexpr std::size_t kMaxParts = 12;

  /// The parts to read at a tick: `count` of `parts`, from `first` on, after the last part the first again.
  struct Due {
    std::size_t parts = 1;
    std::size_t first = 0;
    std::size_t count = 1;
    double lead_s = 0.0;  ///< 0: the values are needed at this tick
  };

  /// Advances to a tick that is dt_s (above 0) after the last one. Without a number all parts are read at once.
  Due advance(std::optional<std::uint64_t> tick, double dt_s) noexcept {
    const std::optional<std::uint64_t> last = last_;
    last_ = tick;
    if (!tick) return {};
    const std::uint64_t passed = last && *last < *tick ? *tick - *last : 1;
    // A step after a long pause is limited, and does not show the interval of ticks.
    if (passed == 1) period_s_ = dt_s;
    const std::size_t parts = parts_at(period_s_);
    if (parts == 1) return {};
    const bool is_everything_due = !last || *last >= *tick || passed >= parts;
    const std::size_t count = is_everything_due ? parts : static_cast<std::size_t>(passed);
    const std::size_t first = static_cast<std::size_t>((*tick + parts + 1 - count) % parts);
    return {.parts = parts, .first = first, .count = count, .lead_s = static_cast<double>(parts) * period_s_};
  }

  /// The rate of a critically damped filter (math::CriticallyDamped) that follows values read by this schedule with the
  /// same response as one of rate `omega_rad_s` for values that are read at each tick.
  ///
  /// A filter's impulse response has the variance 2 / omega^2. Straight lines between values that are n ticks of p
  /// seconds apart smooth by a triangle of 2 n - 1 ticks, whose variance is (n^2 - 1) p^2 / 6; variances add up. To 2
  /// Hz the magnitudes agree within 0.21 dB.
  static double matched_rate_rad_s(double omega_rad_s, const Due& due) noexcept {
    const auto parts = static_cast<double>(due.parts);
    const double period_s = due.lead_s / parts;
    const double variance_s2 = (parts * parts - 1.0) * period_s * period_s / 12.0;
    return 1.0 / std::sqrt(1.0 / (omega_rad_s * omega_rad_s) - variance_s2);
  }

  void list_state(StatePass& pass) {
    pass(last_);
    pass.within(period_s_, 1e-6, StatePass::kLargest);
  }

 private:
  static std::size_t parts_at(double period_s) noexcept {
    constexpr double kRounding = 1e-6;
    const double ticks = 1.0 / (kReadings_hz * period_s) + kRounding;
    return static_cast<std::size_t>(std::clamp(ticks, 1.0, static_cast<double>(kMaxParts)));
  }

  std::optional<std::uint64_t> last_;
  double period_s_ = 1.0;  ///< from tick to tick
};

}  // namespace yuragi::scenes
