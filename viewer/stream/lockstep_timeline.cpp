#include "viewer/stream/lockstep_timeline.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace yuragi::viewer::stream {

void LockstepTimeline::set_scenes(std::span<const wire::SceneModel> scenes) {
  before_ = newest_ = shown_ = rest_moment(scenes);
  count_ = 0;
}

bool LockstepTimeline::accept(wire::Frame& frame) {
  if (frame.poses.size() != newest_.poses.size() || frame.opacities.size() != frame.poses.size()) return false;
  if (!std::isfinite(frame.info.time_s) || (has_begun() && frame.info.time_s <= newest_.time_s)) return false;
  for (std::size_t scene = 0; scene < frame.poses.size(); ++scene) {
    const bool is_left_out = frame.opacities[scene] <= 0.0F && value_bytes({&frame.poses[scene], 1}) == 0;
    if (is_left_out) frame.poses[scene] = newest_.poses[scene];
  }
  if (!has_same_layout(frame.poses, newest_.poses)) return false;

  std::swap(before_, newest_);
  std::swap(newest_.poses, frame.poses);
  std::swap(newest_.opacities, frame.opacities);
  newest_.time_s = frame.info.time_s;
  newest_.wind = frame.info.wind;
  newest_.view_wind_from_deg = frame.info.view_wind_from_deg;
  count_ = std::min(count_ + 1, 2);
  return true;
}

const PoseMoment& LockstepTimeline::at(double time_s) {
  if (count_ < 2) return newest_;
  const double part = (time_s - before_.time_s) / (newest_.time_s - before_.time_s);
  blend(before_, newest_, std::clamp(part, 0.0, 1.0), shown_);
  return shown_;
}

}  // namespace yuragi::viewer::stream
