#include "drivers/text/wind_choice.hpp"

#include <algorithm>

namespace yuragi::drivers::text {
namespace {

/// A source that misses so many of its own pauses has fallen silent.
constexpr int kMissedPauses = 3;
constexpr Nanoseconds kShortestAbsence = std::chrono::seconds(3);

}  // namespace

WindChoice::Verdict WindChoice::offer(const Source& source, MonoTime now) {
  if (wanted_ && source.frame != *wanted_) return Verdict::kForeign;
  best_frame_ = best_frame_ ? std::min(*best_frame_, source.frame) : source.frame;

  if (current_ == source) {
    pause_ = now - last_;
    last_ = now;
    is_settled_ = true;
    return Verdict::kTake;
  }

  const bool is_first = !current_;
  const bool is_better = current_ && source.frame < current_->frame;
  const bool is_silent = current_ && now - last_ > std::max(kShortestAbsence, kMissedPauses * pause_);
  if (!is_first && !is_better && !is_silent) return Verdict::kPass;
  current_ = source;
  last_ = now;
  pause_ = {};
  if (is_silent) return Verdict::kTake;
  // Later than in the first burst: the other source has sent this measurement already.
  return is_settled_ ? Verdict::kPass : Verdict::kHold;
}

void WindChoice::restart() noexcept {
  current_.reset();
  is_settled_ = false;
}

}  // namespace yuragi::drivers::text
