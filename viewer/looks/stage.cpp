#include "viewer/looks/stage.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "engine/pose/pose_arrays.hpp"
#include "viewer/meshes/shadow_view.hpp"

namespace yuragi::viewer::looks {
namespace {

constexpr meshes::Bounds kPartOfGround{glm::vec3(-4.0F, 0.0F, -4.0F), glm::vec3(4.0F, 0.8F, 4.0F)};
constexpr int kMediumTexels = 1024;
constexpr int kHighTexels = 2048;
constexpr int kMirror = 2;           // a mirror's pixel is as large as so many of the picture, across and upright
constexpr int kLowMirror = 4;        // with quality low
constexpr float kLowestSun = 0.02F;  // the sine of its height: below it shadows have no end

bool is_alike(const meshes::Stand& a, const meshes::Stand& b) {
  return a.length_m == b.length_m && a.blades_per_m2 == b.blades_per_m2;
}

}  // namespace

void Stage::set_scenes(std::vector<wire::SceneModel> scenes) {
  std::vector<std::unique_ptr<SceneView>> before = std::exchange(views_, {});
  scenes_.clear();
  ground_.set_standing({});  // it refers to the skeletons
  for (wire::SceneModel& scene : scenes) {
    const auto same = std::ranges::find_if(before, [&](const auto& view) {
      return view && view->scene.kind == scene.kind && view->scene.skeleton == scene.skeleton &&
             view->scene.cloth == scene.cloth;
    });
    if (same != before.end()) {
      views_.push_back(std::move(*same));
      views_.back()->scene.name = std::move(scene.name);
    } else {
      auto view = std::make_unique<SceneView>();
      view->scene = std::move(scene);
      view->bounds = meshes::bounds_of(view->scene.skeleton);
      view->renderer = make_scene_renderer(view->scene, quality_);
      view->bounds = view->renderer->bounds_with_holder(view->bounds);
      if (const auto* strands = std::get_if<pose::StrandSkeleton>(&view->scene.skeleton)) {
        view->grid = meshes::bend_grid_of(*strands);
        if (view->renderer->is_field() && !view->renderer->is_ground()) view->stand = meshes::stand_of(*strands);
      }
      const auto* surface = std::get_if<pose::SurfaceSkeleton>(&view->scene.skeleton);
      if (surface != nullptr && surface->ramp_rgba.empty()) view->shore = meshes::Shore(*surface);
      views_.push_back(std::move(view));
    }
    scenes_.push_back(&views_.back()->scene);
  }
  const bool is_there = std::ranges::any_of(scenes_, [&](const auto* scene) { return only_ && scene->name == *only_; });
  if (!is_there) only_.reset();
}

void Stage::show_next() {
  const auto is_only = [this](const wire::SceneModel* scene) { return only_ && scene->name == *only_; };
  const auto now = std::find_if(scenes_.begin(), scenes_.end(), is_only);
  const auto next = now == scenes_.end() ? scenes_.begin() : std::next(now);
  only_ = next == scenes_.end() ? std::nullopt : std::optional((*next)->name);
}

/// The box around the scenes for which `is_chosen`; nothing where there are none.
template <class IsChosen>
std::optional<meshes::Bounds> Stage::around(IsChosen&& is_chosen) const {
  std::optional<meshes::Bounds> all;
  for (std::size_t i = 0; i < views_.size(); ++i) {
    if (is_chosen(i)) all = all ? united(*all, views_[i]->bounds) : views_[i]->bounds;
  }
  return all;
}

meshes::Bounds Stage::bounds() const {
  // The ground is everywhere: where it is alone, a part of it.
  const auto is_thing = [this](std::size_t scene) { return is_chosen(scene) && !views_[scene]->renderer->is_ground(); };
  const bool is_ground_alone =
      !views_.empty() && std::ranges::all_of(views_, [](const auto& view) { return view->renderer->is_ground(); });
  return around(is_thing).value_or(is_ground_alone || only_ ? kPartOfGround : meshes::Bounds{});
}

meshes::CameraPlace Stage::home(double aspect) const {
  bool is_all_field = true;
  for (std::size_t scene = 0; scene < views_.size(); ++scene) {
    is_all_field = is_all_field && (!is_chosen(scene) || views_[scene]->renderer->is_field());
  }
  if (is_all_field) return meshes::place_across(bounds());
  const auto chosen = [this](std::size_t scene) { return is_chosen(scene) && !views_[scene]->renderer->is_ground(); };
  std::size_t scene = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < views_.size(); ++i) {
    if (!chosen(i)) continue;
    scene = i;
    ++count;
  }
  if (count == 1 && views_[scene]->shore.is_pond()) return meshes::place_on_shore(views_[scene]->shore);
  if (count == 1 && views_[scene]->scene.kind == "fur") return meshes::place_beside(bounds());
  return meshes::place_around(bounds(), aspect);
}

std::optional<meshes::Bounds> Stage::bounds_of(std::string_view scene) const {
  const auto found = std::ranges::find_if(views_, [&](const auto& view) { return view->scene.name == scene; });
  if (found == views_.end()) return std::nullopt;
  return (*found)->renderer->is_ground() ? kPartOfGround : (*found)->bounds;
}

std::size_t Stage::node_count() const {
  std::size_t count = 0;
  for (const wire::SceneModel* scene : scenes_) count += pose::node_count(scene->skeleton);
  return count;
}

bool Stage::is_seen(const stream::PoseMoment& moment, std::size_t scene) const {
  return is_chosen(scene) && scene < moment.poses.size() && scene < moment.opacities.size() &&
         moment.opacities[scene] > 0.0F && pose::fits(moment.poses[scene], scenes_[scene]->skeleton);
}

/// Gives each renderer its pose, and asks which light it throws.
void Stage::move_to(const stream::PoseMoment& moment) {
  const SceneRenderer::Moment now{
      .time_s = moment.time_s,
      .wind_m_s = {static_cast<float>(moment.wind.wind.u_m_s), -static_cast<float>(moment.wind.wind.v_m_s)},
      .flame_brightness = light::flame_brightness(light_.air.x)};
  fires_.clear();
  for (std::size_t scene = 0; scene < views_.size(); ++scene) {
    if (!is_seen(moment, scene)) continue;
    SceneRenderer& renderer = *views_[scene]->renderer;
    renderer.set_moment(now);
    renderer.move_to(moment.poses[scene]);
    renderer.set_blade_share(blade_share_);
    if (std::optional<light::Fire> fire = renderer.fire()) {
      fire->light *= moment.opacities[scene];
      fires_.push_back(*fire);
    }
  }
}

/// What stands on the ground, and how its grass is bent.
void Stage::move_ground(const stream::PoseMoment& moment) {
  standing_.clear();
  tall_ = 0.0F;
  tall_door_ = 0;
  stand_ = {};
  bool is_bare = true;  // no grass is streamed, and the ground is
  const pose::StrandPose* nodes = nullptr;
  const pose::StrandPose* near_by = nullptr;
  meshes::BendGrid grid;
  float ground_opacity = 0.0F;
  for (std::size_t scene = 0; scene < views_.size(); ++scene) {
    const SceneView& view = *views_[scene];
    const bool fits = scene < moment.poses.size() && scene < moment.opacities.size() &&
                      pose::fits(moment.poses[scene], scenes_[scene]->skeleton);
    if (view.renderer->is_ground()) {
      // It moves the grass around whatever scene is chosen.
      if (!fits || moment.opacities[scene] <= 0.0F) continue;
      nodes = std::get_if<pose::StrandPose>(&moment.poses[scene]);
      grid = view.grid;
      ground_opacity = std::max(ground_opacity, moment.opacities[scene]);
      continue;
    }
    is_bare = is_bare && !is_chosen(scene);
    if (!is_seen(moment, scene)) continue;
    const float opacity = moment.opacities[scene];
    meshes::Standing& thing = standing_.emplace_back();
    thing.bounds = view.bounds;
    thing.floor = view.renderer->floor();
    thing.opacity = opacity;
    if (view.stand) {
      thing.kind = meshes::Standing::Kind::kGrass;
      thing.blades = std::get_if<pose::StrandSkeleton>(&view.scene.skeleton);
      if (opacity > tall_) {
        tall_ = opacity;
        tall_door_ = scene;
        stand_ = *view.stand;
        near_by = std::get_if<pose::StrandPose>(&moment.poses[scene]);
      }
    } else if (view.scene.kind == "fur") {
      thing.kind = meshes::Standing::Kind::kFur;
    } else if (view.shore.is_pond()) {
      thing.kind = meshes::Standing::Kind::kWater;
      thing.shore = &view.shore;
    } else if (std::holds_alternative<pose::SurfaceSkeleton>(view.scene.skeleton)) {
      thing.kind = meshes::Standing::Kind::kFire;
    }
  }
  if (is_bare && ground_opacity > 0.0F) {
    tall_ = ground_opacity;
    stand_ = {};
  }
  ground_.set_standing(standing_, light_.colors.z);
  ground_.move_to(grid, nodes, near_by);
  ground_.bind(stand_, tall_, tall_door_);
}

void Stage::draw_sward(const meshes::View& view) {
  if (tall_ > 0.0F) {
    if (!meadow_ || !meadow_stand_ || !is_alike(*meadow_stand_, stand_)) {
      meadow_.emplace(Sward::Kind::kTall, stand_, grass_detail(quality_));
      meadow_stand_ = stand_;
    }
    door_.open(tall_, tall_door_);
    meadow_->set_blade_share(blade_share_);
    meadow_->draw(view, ground_.growth());
    door_.close();
  }
  if (tall_ < 1.0F) {
    if (!lawn_) lawn_.emplace(Sward::Kind::kLawn, stand_, grass_detail(quality_));
    lawn_->set_blade_share(blade_share_);
    lawn_->draw(view, ground_.growth());
  }
}

void Stage::set_quality(look::Quality quality) {
  if (quality == quality_) return;
  quality_ = quality;
  for (const auto& view : views_) view->renderer = make_scene_renderer(view->scene, quality_);
  meadow_.reset();
  lawn_.reset();
  landscape_.set_quality(quality);
  const int texels =
      quality == look::Quality::kLow ? 0 : (quality == look::Quality::kMedium ? kMediumTexels : kHighTexels);
  shadow_map_.reset();
  if (texels > 0) shadow_map_.emplace(texels);
}

/// Draws what the sun sees of everything that casts a shadow, for `view` to look it up.
void Stage::draw_shadows(const stream::PoseMoment& moment, const glm::vec3& to_sun, meshes::View& view) {
  const auto casts = [&](std::size_t scene) {
    return is_seen(moment, scene) && views_[scene]->renderer->casts_shadow();
  };
  std::optional<meshes::Bounds> casters = around(casts);
  if (!casters) return;
  // What stands on a floor is blown out over it.
  for (std::size_t scene = 0; scene < views_.size(); ++scene) {
    if (!casts(scene)) continue;
    if (const auto floor = views_[scene]->renderer->floor()) casters = united(*casters, meshes::bounds_of(*floor));
  }
  const meshes::View shadows = meshes::shadow_view(*casters, to_sun, shadow_map_->texels());
  view_buffer_.set(shadows);
  view_buffer_.set(light_);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glDisable(GL_SCISSOR_TEST);
  shadow_map_->begin();
  for (std::size_t scene = 0; scene < views_.size(); ++scene) {
    if (!casts(scene)) continue;
    door_.open(moment.opacities[scene], scene);
    views_[scene]->renderer->draw_shadow(shadows);
    door_.close();
  }
  shadow_map_->end();
  meshes::add_shadows(view, shadows, shadow_map_->texels());
}

/// Draws what the water in view mirrors, with less work than the picture is.
void Stage::draw_mirror(const stream::PoseMoment& moment, const meshes::View& view, const gl::RenderTarget& target) {
  const std::array<glm::vec4, 5> planes = meshes::side_planes(view);
  std::optional<float> height_m;
  for (std::size_t scene = 0; scene < views_.size() && !height_m; ++scene) {
    const meshes::Bounds& box = views_[scene]->bounds;
    if (!is_seen(moment, scene) || !meshes::is_in_view(planes, box.low_m, box.high_m)) continue;
    height_m = views_[scene]->renderer->mirror_m();
  }
  if (!height_m) return;
  const int smaller = quality_ == look::Quality::kLow ? kLowMirror : kMirror;
  const int width_px = std::max(1, target.drawn_width_px() / smaller);
  const int height_px = std::max(1, target.drawn_height_px() / smaller);
  if (!mirror_ || mirror_->width_px() != width_px || mirror_->height_px() != height_px) {
    mirror_.reset();
    mirror_.emplace(width_px, height_px);
  }
  const meshes::View image = meshes::mirrored(view, *height_m, 1.0F / static_cast<float>(smaller));
  view_buffer_.set(image);
  mirror_->begin();
  // With low quality the sky, the hills and fires alone.
  for (std::size_t scene = 0; scene < views_.size(); ++scene) {
    SceneRenderer& renderer = *views_[scene]->renderer;
    if (!is_seen(moment, scene) || renderer.is_field()) continue;
    if (quality_ == look::Quality::kLow && !renderer.mirror_m()) continue;
    door_.open(moment.opacities[scene], scene);
    renderer.draw_mirrored(image);
    door_.close();
  }
  if (quality_ == look::Quality::kHigh || quality_ == look::Quality::kAuto) draw_sward(image);
  landscape_.draw_mirrored_sky(image);
  for (std::size_t scene = 0; scene < views_.size(); ++scene) {
    if (is_seen(moment, scene)) views_[scene]->renderer->draw_light();
  }
  mirror_->end();
  view_buffer_.set(view);
  mark_pass("mirror");
}

void Stage::draw(const stream::PoseMoment& moment, const meshes::OrbitCamera& camera, gl::RenderTarget& target) {
  meshes::View view = meshes::view_of(camera, target.drawn_width_px(), target.drawn_height_px());
  if (clock_ != nullptr) clock_->begin();
  const glm::vec3 to_sun(light_.to_sun);
  const bool has_shadows = to_sun.y > kLowestSun;
  move_to(moment);
  view_buffer_.set(light::nearest_fires(fires_, glm::vec3(view.eye_m)));
  mark_pass("kinematics");
  view_buffer_.set(light_);
  for (std::size_t scene = 0; scene < views_.size(); ++scene) {
    if (is_seen(moment, scene)) views_[scene]->renderer->prepare(view, view_buffer_);
  }
  if (has_shadows && shadow_map_) {
    draw_shadows(moment, to_sun, view);
    mark_pass("shadows");
  }
  const bool has_flat_shadows = has_shadows && !shadow_map_;
  const meshes::View flat = has_flat_shadows ? meshes::laid_flat(view, to_sun) : view;
  view_buffer_.set(view);
  view_buffer_.set(light_);
  landscape_.prepare(light_, view, target.drawn_width_px(), target.drawn_height_px());
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glDisable(GL_SCISSOR_TEST);
  move_ground(moment);
  mark_pass("ground maps");
  draw_mirror(moment, view, target);
  target.begin();
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
  for (std::size_t scene = 0; scene < views_.size(); ++scene) {
    if (!is_seen(moment, scene)) continue;
    SceneRenderer& renderer = *views_[scene]->renderer;
    door_.open(moment.opacities[scene], scene);
    renderer.draw(view);
    door_.begin_mark(gl::kHole);
    renderer.draw_hole();
    door_.end_mark();
    mark_pass(scenes_[scene]->kind);
    if (has_flat_shadows && renderer.casts_shadow()) {
      view_buffer_.set(flat);
      door_.begin_mark(gl::kShadow);
      renderer.draw_shadow(flat);
      door_.end_mark();
      view_buffer_.set(view);
      mark_pass("shadows");
    }
    door_.close();
  }
  draw_sward(view);
  mark_pass("sward");
  landscape_.draw_ground();
  mark_pass("ground");
  landscape_.draw_sky(view);
  mark_pass("hills and sky");
  for (std::size_t scene = 0; scene < views_.size(); ++scene) {
    if (!is_seen(moment, scene)) continue;
    door_.open(moment.opacities[scene], scene);
    views_[scene]->renderer->draw_light();
    door_.close();
  }
  mark_pass("lights");
  target.resolve();
  mark_pass("resolving");
}

}  // namespace yuragi::viewer::looks
