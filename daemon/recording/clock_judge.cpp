#include "daemon/recording/clock_judge.hpp"

#include <chrono>
#include <cmath>

#include "daemon/settings/duration_text.hpp"
#include "drivers/windlog/iso_time.hpp"

namespace yuragi::daemon::recording {
namespace {

// Differences are taken of floating numbers: those of times from a damaged file do not fit into Nanoseconds.
double since_epoch_s(UtcTime time) {
  return seconds(time.time_since_epoch());
}

double utc_less_mono_s(Instant instant) {
  return since_epoch_s(instant.utc) - seconds(instant.mono.time_since_epoch());
}

ClockDoubt doubt_of(UtcTime now, bool is_at_start, double ahead_s) {
  return {.since = std::chrono::floor<std::chrono::seconds>(now),
          .is_at_start = is_at_start,
          .ahead_s = std::llround(ahead_s)};
}

}  // namespace

void ClockJudge::look(Instant now, bool is_synchronized) {
  if (latest_ && now.mono < latest_->mono) return;
  const double max_step_s = seconds(kMaxClockStep);
  if (latest_) {
    if (doubt_) doubt_->running += now.mono - latest_->mono;
    const double step_s = utc_less_mono_s(now) - utc_less_mono_s(*latest_);
    if (std::abs(step_s) > max_step_s) doubt_ = doubt_of(now.utc, false, step_s);
  } else if (newest_) {
    const double ahead_s = since_epoch_s(now.utc) - since_epoch_s(*newest_);
    if (ahead_s < -max_step_s || ahead_s > seconds(kMaxAbsence)) doubt_ = doubt_of(now.utc, true, ahead_s);
  }
  latest_ = now;
  if (is_synchronized || (doubt_ && doubt_->running >= kDoubt)) doubt_.reset();
}

std::string text_of(const ClockDoubt& doubt) {
  const bool is_ahead = doubt.ahead_s > 0;
  const std::string by = settings::duration_text(std::abs(static_cast<double>(doubt.ahead_s)));
  const std::string why = doubt.is_at_start
                              ? "a start was " + by + (is_ahead ? " after" : " before") + " the newest reading"
                              : "it jumped " + std::string(is_ahead ? "ahead" : "back") + " by " + by;
  return "the clock may be wrong since " + drivers::windlog::iso_time_text(doubt.since) + ": " + why +
         "; recordings are not deleted by age until it has run for another " +
         settings::duration_text(seconds(ClockJudge::kDoubt - doubt.running)) + " or is synchronized";
}

}  // namespace yuragi::daemon::recording
