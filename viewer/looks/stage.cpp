#include "viewer/looks/stage.hpp"

#include <algorithm>

#include "engine/pose/pose_arrays.hpp"

namespace yuragi::viewer::looks {
namespace {

/// The box around those of the bounds for which `is_chosen`; nothing where there are none.
template <class IsChosen>
std::optional<meshes::Bounds> around(const std::vector<meshes::Bounds>& bounds, IsChosen&& is_chosen) {
  std::optional<meshes::Bounds> all;
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    if (is_chosen(i)) all = all ? united(*all, bounds[i]) : bounds[i];
  }
  return all;
}

constexpr meshes::Bounds kNoField{glm::vec3(1e6F), glm::vec3(-1e6F)};

}  // namespace

void Stage::set_scenes(std::vector<wire::SceneModel> scenes) {
  renderers_.clear();
  bounds_.clear();
  scenes_ = std::move(scenes);
  for (const wire::SceneModel& scene : scenes_) {
    bounds_.push_back(meshes::bounds_of(scene.skeleton));
    renderers_.push_back(make_scene_renderer(scene));
  }
}

void Stage::show_next() {
  const auto is_only = [this](const wire::SceneModel& scene) { return only_ && scene.name == *only_; };
  const auto now = std::find_if(scenes_.begin(), scenes_.end(), is_only);
  const auto next = now == scenes_.end() ? scenes_.begin() : std::next(now);
  only_ = next == scenes_.end() ? std::nullopt : std::optional(next->name);
}

meshes::Bounds Stage::bounds() const {
  return around(bounds_, [this](std::size_t scene) { return is_chosen(scene); }).value_or(meshes::Bounds{});
}

meshes::CameraPlace Stage::home(double aspect) const {
  bool is_all_field = true;
  for (std::size_t scene = 0; scene < renderers_.size(); ++scene) {
    is_all_field = is_all_field && (!is_chosen(scene) || renderers_[scene]->is_field());
  }
  return is_all_field ? meshes::place_across(bounds()) : meshes::place_around(bounds(), aspect);
}

std::size_t Stage::node_count() const {
  std::size_t count = 0;
  for (const wire::SceneModel& scene : scenes_) count += pose::node_count(scene.skeleton);
  return count;
}

bool Stage::is_seen(const stream::PoseMoment& moment, std::size_t scene) const {
  return is_chosen(scene) && scene < moment.poses.size() && scene < moment.opacities.size() &&
         moment.opacities[scene] > 0.0F && pose::fits(moment.poses[scene], scenes_[scene].skeleton);
}

meshes::Bounds Stage::field(const stream::PoseMoment& moment) const {
  const auto grows = [&](std::size_t scene) {
    return is_seen(moment, scene) && renderers_[scene]->is_field() && moment.opacities[scene] > 0.5F;
  };
  return around(bounds_, grows).value_or(kNoField);
}

void Stage::draw(const stream::PoseMoment& moment, const meshes::OrbitCamera& camera, gl::RenderTarget& target) {
  const meshes::View view = meshes::view_of(camera, target.width_px(), target.height_px(), field(moment));
  const meshes::View flat = meshes::laid_flat(view);
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
    door_.begin_mark(gl::kHole);
    renderer.draw_hole();
    door_.end_mark();
    if (renderer.casts_shadow()) {
      view_buffer_.set(flat);
      door_.begin_mark(gl::kShadow);
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

}  // namespace yuragi::viewer::looks
