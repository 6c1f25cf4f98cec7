#pragma once

#include <algorithm>
#include <optional>

#include "engine/base/state_pass.hpp"
#include "engine/wind/blend/reading_interval.hpp"
#include "engine/wind/source_report.hpp"

namespace yuragi::wind::blend {

/// An estimator's record of one source: its last reading, and the interval between new ones. Thread-safe: no.
/// Realtime-safe: yes.
class SourceRecord {
 public:
  /// `unchanged_for_s`: a silence of up to this long means that nothing has changed (SourceSettings).
  explicit SourceRecord(double unchanged_for_s = 0.0) noexcept
      : unchanged_for_s_(unchanged_for_s),
        interval_(unchanged_for_s > 0.0 ? ReadingInterval::Speaks::kOnChange : ReadingInterval::Speaks::kAtIntervals) {}

  /// Takes a plausible reading, not older than the last. Returns whether it is a new one (ReadingInterval::take).
  bool take(const Reading& reading) noexcept {
    const bool is_new =
        !last_ || interval_.take(seconds(reading.time.mono - last_->time.mono), has_same_values(reading, *last_));
    last_ = reading;
    return is_new;
  }

  /// Its last reading is still valid at `time`: nothing new, but it is not silent.
  void hold(Instant time) noexcept {
    if (last_) last_->time = time;
  }

  bool has_reading() const noexcept { return last_.has_value(); }
  const std::optional<Reading>& last() const noexcept { return last_; }

  /// Between new readings; 0 before the second reading.
  double interval_s() const noexcept { return interval_.interval_s(); }
  /// The same, with an assumption for a source that has sent one reading.
  double expected_interval_s() const noexcept { return interval_s() > 0.0 ? interval_s() : kAssumedInterval_s; }

  /// Of the last reading; 0 before the first.
  double age_s(MonoTime now) const noexcept { return last_ ? std::max(0.0, seconds(now - last_->time.mono)) : 0.0; }

  /// Returns the length of a silence that is explained independent of the interval, if `intervals` of its own are
  /// usual: while silence means that nothing has changed; and while the interval can still be that of repetitions.
  double explained_s(double intervals) const noexcept {
    const bool may_repeat_itself = interval_s() > 0.0 && !interval_.is_settled();
    return std::max(unchanged_for_s_, may_repeat_itself ? intervals * kUnsettledInterval_s : 0.0);
  }

  /// Returns true if it has sent a reading within `stale_intervals` of its own intervals (at least a second), or if its
  /// silence is explained otherwise.
  bool is_live(MonoTime now, double stale_intervals) const noexcept {
    return is_on_time(now, stale_intervals) || (last_ && age_s(now) <= explained_s(stale_intervals));
  }

  SourceReport report(MonoTime now, double stale_intervals) const noexcept {
    if (!last_) return {};
    const bool is_live_now = is_live(now, stale_intervals);
    return {.health = is_live_now ? SourceHealth::kLive : SourceHealth::kStale,
            .interval_s = interval_s(),
            .age_s = age_s(now),
            .is_overdue = is_live_now && !is_on_time(now, stale_intervals),
            .last = last_};
  }

  void list_state(StatePass& pass) { pass(last_, interval_); }

 private:
  bool is_on_time(MonoTime now, double stale_intervals) const noexcept {
    return last_ && age_s(now) <= std::max(kMinStaleAfter_s, stale_intervals * expected_interval_s());
  }

  static constexpr double kAssumedInterval_s = 2.0;
  static constexpr double kMinStaleAfter_s = 1.0;
  /// For a station that repeats each message: more than the 18 s of Acurite's.
  static constexpr double kUnsettledInterval_s = 20.0;

  std::optional<Reading> last_;
  double unchanged_for_s_;
  ReadingInterval interval_;
};

}  // namespace yuragi::wind::blend
