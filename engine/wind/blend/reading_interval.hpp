#pragma once

#include <array>
#include <cstddef>

#include "engine/base/state_pass.hpp"

namespace yuragi::wind::blend {

/// How often a source reports something new, from the gaps between its readings (engine/wind/model.md W38).
///
/// For a station that sends regularly it is the median of its last nine gaps. That would be too short for a station
/// that sends in bursts (it repeats each message, or sends several at once, or alternates between two rates): for these
/// the time between bursts is used. It sends in bursts if at least a quarter of the last 16 gaps are shorter than a
/// quarter of its usual pause; half of the time, without the longest gap, is spent in gaps up to the usual pause. So
/// one outage does not count as a pause, and every pattern that repeats within 16 readings is recognised.
///
/// A source that sends only changes reports something new only when its reading differs; its interval is the median of
/// the last nine times from one change to the next.
///
/// Thread-safe: no. Realtime-safe: yes; no allocation.
class ReadingInterval {
 public:
  enum class Speaks : bool { kAtIntervals, kOnChange };

  explicit ReadingInterval(Speaks speaks = Speaks::kAtIntervals) noexcept : speaks_(speaks) {}

  /// Takes each reading except the first, `gap_s` (0 or more) after the one before. `is_same`: with the same values.
  /// Returns whether it is a new one: false for a repetition, or another one of the same burst.
  bool take(double gap_s, bool is_same) noexcept;

  /// s; 0 before the second reading.
  double interval_s() const noexcept { return interval_s_; }

  /// Returns true if the interval is known well. Not while all readings so far are the same few, which can be one
  /// message of a station that repeats each.
  bool is_settled() const noexcept { return is_settled_; }

  void list_state(StatePass& pass) {
    for (double& gap_s : gaps_s_) pass.total(gap_s);
    pass(seen_, is_in_bursts_, is_settled_);
    for (double* time_s : {&interval_s_, &since_new_s_, &soonest_change_s_}) pass.total(*time_s);
  }

 private:
  static constexpr std::size_t kKept = 16;

  bool take_change(double gap_s, bool is_same) noexcept;
  std::size_t count() const noexcept { return seen_ < kKept ? seen_ : kKept; }
  double median_s() const noexcept;
  void measure() noexcept;

  Speaks speaks_;
  std::array<double, kKept> gaps_s_{};  ///< a ring of those above 0
  std::size_t seen_ = 0;
  double interval_s_ = 0.0;
  bool is_in_bursts_ = false;
  bool is_settled_ = false;
  double since_new_s_ = 0.0;       ///< time between the last two new readings
  double soonest_change_s_ = 0.0;  ///< the shortest gap in which the reading changed; 0: it has not changed
};

}  // namespace yuragi::wind::blend
