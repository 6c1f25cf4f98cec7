#include "viewer/looks/stage.hpp"

#include <algorithm>

#include "engine/pose/pose_arrays.hpp"

namespace yuragi {
namespace {

/// The box around those of the bounds for which `is_chosen`; nothing where there are none.
template <class IsChosen>
std::optional<Bounds> around(const std::vector<Bounds>& bounds, IsChosen&& is_chosen) {
  std::optional<Bounds> all;
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    if (is_chosen(i)) all = all ? united(*all, bounds[i]) : bounds[i];
  }
  return all;
}

constexpr Bounds kNoField{glm::vec3(1e6F), glm::vec3(-1e6F)};

}  // namespace

void Stage::set_scenes(std::vector<wire::SceneModel> scenes) {
  renderers_.clear();
  bounds_.clear();
  scenes_ = std::move(scenes);
  for (const wire::SceneModel& scene : scenes_) {
    bounds_.push_back(bounds_of(scene.skeleton));
    renderers_.push_back(make_scene_renderer(scene));
  }
}

void Stage::show_next() {
  const auto is_only = [this](const wire::SceneModel& scene) { return only_ && scene.name == *only_; };
  const auto now = std::find_if(scenes_.begin(), scenes_.end(), is_only);
  const auto next = now == scenes_.end() ? scenes_.begin() : std::next(now);
  only_ = next == scenes_.end() ? std::nullopt : std::optional(next->name);
}

Bounds Stage::bounds() const {
  return around(bounds_, [this](std::size_t scene) { return is_chosen(scene); }).value_or(Bounds{});
}

CameraPlace Stage::home(double aspect) const {
  bool is_all_field = true;
  for (std::size_t scene = 0; scene < renderers_.size(); ++scene) {
    is_all_field = is_all_field && (!is_chosen(scene) || renderers_[scene]->is_field());
  }
  return is_all_field ? place_across(bounds()) : place_around(bounds(), aspect);
}

std::size_t Stage::node_count() const {
  std::size_t count = 0;
  for (const wire::SceneModel& scene : scenes_) count += yuragi::node_count(scene.skeleton);
  return count;
}

bool Stage::is_seen(const PoseMoment& moment, std::size_t scene) const {
  return is_chosen(scene) && scene < moment.poses.size() && scene < moment.opacities.size() &&
         moment.opacities[scene] > 0.0F && fits(moment.poses[scene], scenes_[scene].skeleton);
}

Bounds Stage::field(const PoseMoment& moment) const {
  const auto grows = [&](std::size_t scene) {
    return is_seen(moment, scene) && renderers_[scene]->is_field() && moment.opacities[scene] > 0.5F;
  };
  return around(bounds_, grows).value_or(kNoField);
}

void Stage::draw(const PoseMoment& moment, const OrbitCamera& camera, RenderTarget& target) {
  const View view = view_of(camera, target.width_px(), target.height_px(), field(moment));
  const View flat = laid_flat(view);
  view_buffer_.set(view);
  target.begin();
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glDisable(GL_SCISSOR_TEST);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);

  for (std::size_t scene = 0; scene < renderers_.size(); ++scene) {
    if (!is_seen(moment, scene)) continue;
    SceneRenderer& renderer = *renderers_[scene];
    renderer.move_to(moment.poses[scene]);
    door_.open(moment.opacities[scene], scene);
    renderer.draw(view);
    door_.begin_mark(kHole);
    renderer.draw_hole();
    door_.end_mark();
    if (renderer.casts_shadow()) {
      view_buffer_.set(flat);
      door_.begin_mark(kShadow);
      renderer.draw(flat);
      door_.end_mark();
      view_buffer_.set(view);
    }
    door_.close();
  }
  landscape_.draw();
  for (std::size_t scene = 0; scene < renderers_.size(); ++scene) {
    if (!is_seen(moment, scene)) continue;
    door_.open(moment.opacities[scene], scene);
    renderers_[scene]->draw_light();
    door_.close();
  }
  target.resolve();
}

}  // namespace yuragi
