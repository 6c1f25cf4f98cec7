#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

#include "engine/wind/source_report.hpp"

namespace yuragi::wind::blend {

/// What an estimator remembers of one source: its last reading, and the interval between readings.
/// Thread-safe: no. Realtime-safe: yes.
class SourceRecord {
 public:
  /// Takes a plausible reading, not older than the last.
  void take(const WindReading& reading) noexcept {
    if (last_) {
      const double interval_s = seconds(reading.time.mono - last_->time.mono);
      if (interval_s > 0.0) {
        intervals_s_[intervals_seen_++ % kIntervalsKept] = interval_s;
        interval_s_ = median_interval_s();
      }
    }
    last_ = reading;
  }

  /// Its last reading still holds at `time`: nothing new, but it is not silent.
  void hold(Instant time) noexcept {
    if (last_) last_->time = time;
  }

  bool has_reading() const noexcept { return last_.has_value(); }
  const std::optional<WindReading>& last() const noexcept { return last_; }

  /// The median of the last intervals; 0 before the second reading.
  double interval_s() const noexcept { return interval_s_; }
  /// The same, with an assumption for a source that has sent one reading.
  double expected_interval_s() const noexcept { return interval_s_ > 0.0 ? interval_s_ : kAssumedInterval_s; }

  /// Of the last reading; 0 before the first.
  double age_s(MonoTime now) const noexcept { return last_ ? std::max(0.0, seconds(now - last_->time.mono)) : 0.0; }

  /// Has it sent a reading within `stale_intervals` of its own intervals (at least a second)?
  bool is_live(MonoTime now, double stale_intervals) const noexcept {
    return last_ && age_s(now) <= std::max(kMinStaleAfter_s, stale_intervals * expected_interval_s());
  }

  SourceReport report(MonoTime now, double stale_intervals) const noexcept {
    if (!last_) return {};
    return {.health = is_live(now, stale_intervals) ? SourceHealth::kLive : SourceHealth::kStale,
            .interval_s = interval_s(),
            .age_s = age_s(now),
            .last = last_};
  }

 private:
  static constexpr std::size_t kIntervalsKept = 9;
  static constexpr double kAssumedInterval_s = 2.0;
  static constexpr double kMinStaleAfter_s = 1.0;

  double median_interval_s() const noexcept {
    const std::size_t count = std::min(intervals_seen_, kIntervalsKept);
    auto sorted = intervals_s_;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(count / 2);
    std::nth_element(sorted.begin(), middle, sorted.begin() + static_cast<std::ptrdiff_t>(count));
    return *middle;
  }

  std::optional<WindReading> last_;
  double interval_s_ = 0.0;
  std::array<double, kIntervalsKept> intervals_s_{};
  std::size_t intervals_seen_ = 0;
};

}  // namespace yuragi::wind::blend
