#include "viewer/stage.hpp"

#include <glm/common.hpp>

namespace yuragi {

void Stage::set_scenes(std::vector<wire::SceneModel> scenes) {
  looks_.clear();
  scenes_ = std::move(scenes);
  bounds_ = {};
  for (const wire::SceneModel& scene : scenes_) {
    const auto& strands = std::get<StrandSkeleton>(scene.skeleton);
    const Bounds bounds = bounds_of(strands);
    bounds_ = looks_.empty() ? bounds
                             : Bounds{glm::min(bounds_.low_m, bounds.low_m), glm::max(bounds_.high_m, bounds.high_m)};
    looks_.push_back(std::make_unique<GrassLook>(strands));
  }
}

std::size_t Stage::node_count() const {
  std::size_t count = 0;
  for (const wire::SceneModel& scene : scenes_) {
    const auto& strands = std::get<StrandSkeleton>(scene.skeleton);
    count += strands.strand_count * strands.links_per_strand;
  }
  return count;
}

void Stage::draw(const PoseMoment& moment, const OrbitCamera& camera, RenderTarget& target) {
  const View view = view_of(camera, target.width_px(), target.height_px(), bounds_);
  view_buffer_.set(view);
  target.begin();
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glDisable(GL_SCISSOR_TEST);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  for (std::size_t i = 0; i < looks_.size() && i < moment.poses.size(); ++i) {
    looks_[i]->draw(std::get<StrandPose>(moment.poses[i]), view);
  }
  landscape_.draw();
  target.resolve();
}

}  // namespace yuragi
