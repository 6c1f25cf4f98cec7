#include "drivers/text/wind_choice.hpp"

#include <algorithm>

namespace yuragi::drivers::text {
namespace {

/// A source that is silent for this many of its own pauses counts as silent.
constexpr int kMissedPauses = 3;
constexpr Nanoseconds kMinAbsence = std::chrono::seconds(3);
/// The same, before a direction in another frame is taken in place of its own.
constexpr int kMissedPausesOfFrame = 10;
constexpr Nanoseconds kMinAbsenceOfFrame = std::chrono::seconds(60);

}  // namespace

void WindChoice::Chosen::hear(MonoTime now) noexcept {
  pause = now - last;
  last = now;
}

bool WindChoice::Chosen::is_silent(MonoTime now, int pauses, Nanoseconds at_least) const noexcept {
  return now - last > std::max(at_least, pauses * pause);
}

WindChoice::Verdict WindChoice::offer(const Source& source, const Said& said, MonoTime now) {
  takes_direction_ = false;
  if (wanted_ && source.frame != *wanted_) return Verdict::kForeign;
  if (said.has_direction) {
    takes_direction_ = offer_direction(source, now);
  } else if (said.is_calm && direction_.source == source) {
    direction_.hear(now);
  }
  return said.has_speed ? offer_speed(source, now) : Verdict::kPass;
}

bool WindChoice::offer_direction(const Source& source, MonoTime now) {
  if (direction_.source == source) {
    direction_.hear(now);
    return true;
  }
  const WindFrame frame = direction_.source.frame;
  const bool is_silent = source.frame == frame ? direction_.is_silent(now, kMissedPauses, kMinAbsence)
                                               : direction_.is_silent(now, kMissedPausesOfFrame, kMinAbsenceOfFrame);
  if (direction_.is_any() && source.frame >= frame && !is_silent) return false;
  direction_ = {.source = source, .last = now};
  return true;
}

WindChoice::Verdict WindChoice::offer_speed(const Source& source, MonoTime now) {
  if (speed_.source == source) {
    speed_.hear(now);
    is_settled_ = true;
    return Verdict::kTake;
  }
  const bool is_better = source.frame < speed_.source.frame;
  const bool is_silent = speed_.is_any() && speed_.is_silent(now, kMissedPauses, kMinAbsence);
  if (speed_.is_any() && !is_better && !is_silent) return Verdict::kPass;
  speed_ = {.source = source, .last = now};
  if (is_silent) return Verdict::kTake;
  // Later than in the first burst: the other source has sent this measurement already.
  return is_settled_ ? Verdict::kPass : Verdict::kHold;
}

void WindChoice::restart() noexcept {
  speed_ = {};
  is_settled_ = false;
}

}  // namespace yuragi::drivers::text
