#include "viewer/stream/pose_track.hpp"

#include <algorithm>
#include <cmath>

namespace yuragi::viewer::stream {
namespace {

constexpr double kTurnEasing_s = 1.0;    // to slow down before a turn, and to speed up after it
constexpr double kFollowGain_1_s = 3.0;  // of the loop by which the shown moment follows the clock's target
constexpr double kAtRest_s = 1e-4;       // a smaller distance to the newest counts as zero
constexpr double kNewRun_s = 1.0;        // the sender's time advanced by this much more than ours: another run

}  // namespace

double back_and_forth_s(double elapsed_s, double span_s) {
  if (span_s <= 0.0) return 0.0;

  // In one direction: speed up over easing_s, move at 1, slow down over easing_s. Short spans never reach 1.
  const double easing_s = std::min(kTurnEasing_s, span_s);
  const double way_s = span_s + easing_s;
  double t = std::fmod(std::max(0.0, elapsed_s), 2.0 * way_s);
  if (t > way_s) t = 2.0 * way_s - t;

  if (t < easing_s) return 0.5 * t * t / easing_s;
  if (t > span_s) return span_s - 0.5 * (way_s - t) * (way_s - t) / easing_s;
  return t - 0.5 * easing_s;
}

void PoseTrack::reset(const PoseMoment& layout) {
  history_.reset(layout);
  clear();
}

void PoseTrack::clear() {
  history_.clear();
  clock_ = {};
  has_advanced_ = false;
  is_replaying_ = false;
  replay_elapsed_s_ = 0.0;
}

bool PoseTrack::continues(double sender_s, double local_s) const {
  if (history_.is_empty()) return true;
  const double forward_s = sender_s - history_.newest().time_s;
  return forward_s > 0.0 && forward_s < (local_s - clock_.last_arrival_s()) + kNewRun_s;
}

void PoseTrack::push(PoseMoment& moment, double local_s) {
  const bool is_first = history_.is_empty();
  clock_.observe(moment.time_s, local_s);
  history_.push(moment);
  if (is_first) {
    last_local_s_ = local_s;
    shown_s_ = clock_.target_s(local_s);
  }
}

double PoseTrack::follow_s(double passed_s, double target_s) const {
  // Follows the target by playing a little faster or slower, and brakes so as to be at rest at the newest.
  const double left_s = std::max(0.0, history_.newest().time_s - shown_s_);
  const double behind_s = target_s - (shown_s_ + passed_s);
  const double wanted = std::clamp(1.0 + kFollowGain_1_s * behind_s, kMinPlayRate, kMaxPlayRate);
  const double braked = std::sqrt(2.0 * left_s / clock_.interval_s());
  return std::min(shown_s_ + std::min(wanted, braked) * passed_s, shown_s_ + left_s);
}

void PoseTrack::advance(double local_s, std::optional<double> target_s, PoseMoment& out) {
  const double passed_s = std::max(0.0, local_s - last_local_s_);
  last_local_s_ += passed_s;

  // Follow the stream; once it is silent and the picture rests at the newest moment, play backward.
  const double newest_s = history_.newest().time_s;
  const double by_arrivals_s = clock_.target_s(local_s);
  if (target_s && !(std::abs(*target_s - by_arrivals_s) < kMaxTarget_s)) target_s.reset();
  if (!has_advanced_ && target_s) shown_s_ = std::min(*target_s - passed_s, newest_s);
  has_advanced_ = true;
  if (is_replaying_) {
    replay_elapsed_s_ += passed_s;
  } else {
    shown_s_ = follow_s(passed_s, target_s.value_or(by_arrivals_s));
    const double silence_s = local_s - clock_.last_arrival_s();
    is_replaying_ = silence_s > std::max(kMinSilence_s, 4.0 * clock_.interval_s()) && newest_s - shown_s_ < kAtRest_s;
  }
  if (is_replaying_) {
    shown_s_ =
        newest_s - back_and_forth_s(replay_elapsed_s_, std::min(kReplaySpan_s, newest_s - history_.oldest().time_s));
  }
  history_.sample(shown_s_, out);
}

}  // namespace yuragi::viewer::stream
