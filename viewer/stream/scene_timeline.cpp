#include "viewer/stream/scene_timeline.hpp"

#include <algorithm>
#include <utility>

namespace yuragi::viewer::stream {
namespace {

bool have_same_skeletons(const std::vector<wire::SceneModel>& a, const std::vector<wire::SceneModel>& b) {
  return std::ranges::equal(a, b, {}, &wire::SceneModel::skeleton, &wire::SceneModel::skeleton);
}

}  // namespace

SceneTimeline::SceneTimeline(std::optional<double> fixed_delay_s) {
  if (fixed_delay_s) fixed_delay_.emplace(*fixed_delay_s);
}

void SceneTimeline::set_scenes(wire::Scenes scenes) {
  const bool is_same = has_scenes_ && have_same_skeletons(scenes.scenes, scenes_);
  if (is_same || scenes.scenes.empty() || present_.playback() == Playback::kNothing) {
    present_.set_scenes(scenes.scenes);
    scenes_ = std::move(scenes.scenes);
    has_scenes_ = is_news_ = true;
    next_.reset();
    return;
  }
  next_.emplace().set_scenes(scenes.scenes);
  next_scenes_ = std::move(scenes.scenes);
  next_begins_s_.reset();
}

bool SceneTimeline::accept(wire::Frame& frame, double local_s) {
  if (fixed_delay_) fixed_delay_->take_frame(frame.info, local_s);
  if (!next_) return present_.accept(frame, local_s);
  const double sender_s = frame.info.time_s;
  if (!next_begins_s_ && present_.continues(sender_s, local_s)) next_->take_clock_of(present_);
  if (!next_->accept(frame, local_s)) return false;
  if (!next_begins_s_) next_begins_s_ = sender_s;
  return true;
}

const PoseMoment& SceneTimeline::advance(double local_s, double utc_s) {
  const std::optional<double> target_s = fixed_delay_ ? fixed_delay_->target_s(local_s, utc_s) : std::nullopt;
  if (next_begins_s_ && next_) {
    next_->advance(local_s, target_s);
    if (next_->shown_s() >= *next_begins_s_) {
      present_ = std::move(*next_);
      next_.reset();
      scenes_ = std::move(next_scenes_);
      is_news_ = true;
    }
  }
  return present_.advance(local_s, target_s);
}

std::optional<std::vector<wire::SceneModel>> SceneTimeline::take_new_scenes() {
  if (!std::exchange(is_news_, false)) return std::nullopt;
  return scenes_;
}

}  // namespace yuragi::viewer::stream
