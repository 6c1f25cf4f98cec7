#include "viewer/stream/pose_timeline.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace yuragi::viewer::stream {

void PoseTimeline::set_scenes(std::span<const wire::SceneModel> scenes) {
  PoseMoment rest = rest_moment(scenes);
  if (has_same_layout(rest.poses, shown_.poses)) return;
  for (PoseTrack& track : tracks_) track.reset(rest);
  fade_ = 1.0;
  incoming_ = faded_ = rest;
  shown_ = std::move(rest);
}

bool PoseTimeline::accept(wire::Frame& frame, double local_s) {
  if (shown_.poses.empty() || frame.opacities.size() != frame.poses.size()) return false;
  stand_in_for_hidden(frame);
  if (!has_same_layout(frame.poses, shown_.poses)) return false;
  if (!std::isfinite(frame.info.time_s)) return false;

  // A stream that resumes or starts again gets a track of its own, to which the picture cross-fades. While an earlier
  // cross-fade runs, this one waits.
  if (current().is_replaying() || !current().continues(frame.info.time_s, local_s)) {
    if (is_fading()) return true;
    current_ = 1 - current_;
    current().clear();
    fade_ = 0.0;
  }

  incoming_.time_s = frame.info.time_s;
  incoming_.tick = frame.info.tick;
  incoming_.wind = frame.info.wind;
  incoming_.view_wind_from_deg = frame.info.view_wind_from_deg;
  std::swap(incoming_.poses, frame.poses);
  std::swap(incoming_.opacities, frame.opacities);
  current().push(incoming_, local_s);
  std::swap(incoming_.poses, frame.poses);
  std::swap(incoming_.opacities, frame.opacities);
  return true;
}

void PoseTimeline::stand_in_for_hidden(wire::Frame& frame) const {
  for (std::size_t scene = 0; scene < std::min(frame.poses.size(), shown_.poses.size()); ++scene) {
    const bool is_left_out = frame.opacities[scene] <= 0.0F && value_bytes({&frame.poses[scene], 1}) == 0;
    if (is_left_out) frame.poses[scene] = shown_.poses[scene];
  }
}

const PoseMoment& PoseTimeline::advance(double local_s, std::optional<double> target_s) {
  const double passed_s = std::max(0.0, local_s - last_local_s_);
  last_local_s_ += passed_s;
  if (current().is_empty()) return shown_;

  current().advance(local_s, target_s, shown_);
  if (is_fading()) {
    tracks_[1 - current_].advance(local_s, std::nullopt, faded_);
    fade_ = std::min(1.0, fade_ + std::min(passed_s, kMaxFadeStep_s) / kFade_s);
    blend(faded_, shown_, fade_ * fade_ * (3.0 - 2.0 * fade_), shown_);
  }
  return shown_;
}

Playback PoseTimeline::playback() const {
  if (current().is_empty()) return Playback::kNothing;
  if (current().is_replaying()) return Playback::kReplaying;
  return is_fading() ? Playback::kReturning : Playback::kLive;
}

}  // namespace yuragi::viewer::stream
