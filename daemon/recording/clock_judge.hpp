#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "engine/base/time.hpp"

namespace yuragi::daemon::recording {

/// A larger step of the clock against monotonic time is a jump.
inline constexpr Nanoseconds kMaxClockStep = std::chrono::hours(1);

/// Why the date of the clock is doubted, and how long the program has run since.
struct ClockDoubt {
  std::chrono::sys_seconds since;  ///< by the clock that is doubted
  bool is_at_start = false;        ///< found at a start; otherwise the clock jumped while the program ran
  std::int64_t ahead_s = 0;        ///< by how much it jumped, or was ahead of the newest time; negative: back, behind
  Nanoseconds running{0};          ///< summed over starts
};

/// Decides whether the date of the clock can be believed: not after a jump, and not if a start is before the newest
/// time that is known (by more than a step), or more than kMaxAbsence after it. A doubt ends when the program has run
/// for kDoubt without another such event, over any number of starts, or as soon as the clock is known to be
/// synchronized. Pure. Thread-safe: no.
class ClockJudge {
 public:
  static constexpr Nanoseconds kMaxAbsence = std::chrono::days(30);  ///< between the newest time and a start
  static constexpr Nanoseconds kDoubt = std::chrono::hours(24);

  /// Believes any date.
  ClockJudge() = default;
  /// `newest`: in the recording at the start; nullopt if it holds nothing. `saved`: the doubt that the previous run
  /// left.
  ClockJudge(std::optional<UtcTime> newest, std::optional<ClockDoubt> saved) : newest_(newest), doubt_(saved) {}

  /// Call again and again; the first call judges the start. A moment that is earlier on monotonic time than a previous
  /// one is ignored.
  void look(Instant now, bool is_synchronized);

  /// Nullopt while the date is believed.
  const std::optional<ClockDoubt>& doubt() const { return doubt_; }

 private:
  std::optional<UtcTime> newest_;
  std::optional<Instant> latest_;
  std::optional<ClockDoubt> doubt_;
};

/// A sentence for the log and the status: since when, why, what follows, and when it ends.
std::string text_of(const ClockDoubt& doubt);

}  // namespace yuragi::daemon::recording
