#include "viewer/looks/stage.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/pose/pose_arrays.hpp"
#include "viewer/looks/lee.hpp"
#include "viewer/meshes/shadow_view.hpp"

namespace yuragi::viewer::looks {
namespace {

constexpr meshes::Bounds kPartOfGround{glm::vec3(-4.0F, 0.0F, -4.0F), glm::vec3(4.0F, 0.8F, 4.0F)};
/// The side of the shadow map.
int shadow_texels(look::Quality quality) {
  switch (quality) {
    case look::Quality::kLow:
      return 512;
    case look::Quality::kMedium:
      return 1024;
    case look::Quality::kHigh:
    case look::Quality::kAuto:
      break;
  }
  return 2048;
}

constexpr int kMirror = 2;        // a mirror's pixel is as large as this many of the picture, across and upright
constexpr int kLowMirror = 3;     // with quality low
constexpr float kMinSun = 0.02F;  // sine of its height: below it shadows are endless

constexpr float kShadowPixels = 1.25F;  // with quality low a shadow is drawn as if its texels had this size
constexpr float kSmallest_px = 2.0F;    // an object with half of this width is not drawn

/// Half the width of water in the picture at which it begins to mirror more than the sky, and at which it mirrors
/// everything.
constexpr float kMirrorFrom_px = 12.0F;
constexpr float kMirrorAll_px = 36.0F;
constexpr float kSameHeight_m = 0.01F;

/// The box, with a margin for movement by the wind.
meshes::Bounds with_room(const meshes::Bounds& box) {
  const glm::vec3 size_m = box.high_m - box.low_m;
  const glm::vec3 room_m = 0.15F * size_m + glm::vec3(0.5F * size_m.y, 0.0F, 0.5F * size_m.y) + 0.2F;
  return {box.low_m - room_m, box.high_m + room_m};
}

/// Around the shadow of a box on the ground.
meshes::Bounds shadow_of(const meshes::Bounds& box, const glm::vec3& to_sun) {
  const auto laid_down = [&](float y_m) {
    const glm::vec3 off_m = to_sun * (-std::max(y_m, 0.0F) / to_sun.y);
    return meshes::Bounds{glm::vec3(box.low_m.x + off_m.x, 0.0F, box.low_m.z + off_m.z),
                          glm::vec3(box.high_m.x + off_m.x, 0.0F, box.high_m.z + off_m.z)};
  };
  return united(laid_down(box.low_m.y), laid_down(box.high_m.y));
}

/// Half of the width of a ball around the box in a picture, pixels; from within, as from its surface.
float half_width_px(const meshes::View& view, const meshes::Bounds& box) {
  const float radius_m = 0.5F * glm::distance(box.low_m, box.high_m);
  const float distance_m = glm::distance(glm::vec3(view.eye_m), 0.5F * (box.low_m + box.high_m));
  return radius_m / (view.eye_m.w * std::max({distance_m, radius_m, 1e-3F}));
}

bool is_large_in_view(const meshes::View& view, const std::array<glm::vec4, 5>& planes, const meshes::Bounds& box) {
  return meshes::is_in_view(planes, box.low_m, box.high_m) && half_width_px(view, box) > kSmallest_px;
}

meshes::View coarser(meshes::View view, float pixels) {
  view.eye_m.w *= pixels;
  return view;
}

/// The wind toward east and south.
glm::vec2 wind_m_s_of(const stream::PoseMoment& moment) {
  return {static_cast<float>(moment.wind.wind.u_m_s), -static_cast<float>(moment.wind.wind.v_m_s)};
}

bool is_alike(const meshes::Stand& a, const meshes::Stand& b) {
  return a.length_m == b.length_m && a.blades_per_m2 == b.blades_per_m2;
}

}  // namespace

void Stage::set_scenes(std::vector<wire::SceneModel> scenes) {
  std::vector<std::unique_ptr<SceneView>> before = std::exchange(views_, {});
  scenes_.clear();
  ground_.set_standing({});  // because it refers to the skeletons
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
  const bool has_only = std::ranges::any_of(scenes_, [&](const auto* scene) { return only_ && scene->name == *only_; });
  if (!has_only) only_.reset();
  seen_.assign(views_.size(), {});
}

void Stage::show_next() {
  const auto is_only = [this](const wire::SceneModel* scene) { return only_ && scene->name == *only_; };
  const auto now = std::find_if(scenes_.begin(), scenes_.end(), is_only);
  const auto next = now == scenes_.end() ? scenes_.begin() : std::next(now);
  only_ = next == scenes_.end() ? std::nullopt : std::optional((*next)->name);
}

/// The box around the scenes for which `is_chosen`; nullopt if there are none.
template <class IsChosen>
std::optional<meshes::Bounds> Stage::around(IsChosen&& is_chosen) const {
  std::optional<meshes::Bounds> all;
  for (std::size_t i = 0; i < views_.size(); ++i) {
    if (is_chosen(i)) all = all ? united(*all, views_[i]->bounds) : views_[i]->bounds;
  }
  return all;
}

meshes::Bounds Stage::bounds() const {
  // The ground is everywhere: if it is the only scene, a part of it is used.
  const auto is_thing = [this](std::size_t scene) { return is_chosen(scene) && !views_[scene]->renderer->is_ground(); };
  const bool is_ground_alone =
      !views_.empty() && std::ranges::all_of(views_, [](const auto& view) { return view->renderer->is_ground(); });
  return around(is_thing).value_or(is_ground_alone || only_ ? kPartOfGround : meshes::Bounds{});
}

meshes::CameraPlace Stage::home(double aspect, double wind_from_deg) const {
  bool is_all_field = true;
  for (std::size_t scene = 0; scene < views_.size(); ++scene) {
    is_all_field = is_all_field && (!is_chosen(scene) || views_[scene]->renderer->is_field());
  }
  if (is_all_field) return meshes::place_across(bounds(), wind_from_deg);
  const auto chosen = [this](std::size_t scene) { return is_chosen(scene) && !views_[scene]->renderer->is_ground(); };
  std::size_t scene = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < views_.size(); ++i) {
    if (!chosen(i)) continue;
    scene = i;
    ++count;
  }
  if (count == 1 && views_[scene]->shore.is_pond()) return meshes::place_on_shore(views_[scene]->shore, wind_from_deg);
  if (count == 1 && views_[scene]->scene.kind == "fur") return meshes::place_beside(bounds(), wind_from_deg);
  // A flag fills the picture; its pole extends below it.
  if (count == 1 && views_[scene]->scene.kind == "flag")
    return meshes::place_around(meshes::bounds_of(views_[scene]->scene.skeleton), aspect, wind_from_deg);
  std::optional<meshes::Bounds> blown;
  for (std::size_t i = 0; i < views_.size(); ++i) {
    if (!chosen(i)) continue;
    const meshes::Bounds box = with_lee(views_[i]->bounds, views_[i]->scene.skeleton, wind_from_deg);
    blown = blown ? united(*blown, box) : box;
  }
  return meshes::place_around(blown.value_or(bounds()), aspect, wind_from_deg);
}

std::vector<meshes::Bounds> Stage::obstacles() const {
  std::vector<meshes::Bounds> boxes;
  for (std::size_t scene = 0; scene < views_.size(); ++scene) {
    const SceneView& view = *views_[scene];
    if (is_chosen(scene) && !view.renderer->is_field() && !view.renderer->is_ground() && !view.shore.is_pond())
      boxes.push_back(view.bounds);
  }
  return boxes;
}

meshes::CameraPlace Stage::outside(const meshes::CameraPlace& place) const {
  meshes::CameraPlace there = place;
  for (std::size_t scene = 0; scene < views_.size(); ++scene) {
    if (is_chosen(scene)) there = views_[scene]->renderer->outside(there);
  }
  return there;
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

bool Stage::is_there(const stream::PoseMoment& moment, std::size_t scene) const {
  return is_chosen(scene) && scene < moment.poses.size() && scene < moment.opacities.size() &&
         moment.opacities[scene] > 0.0F && pose::fits(moment.poses[scene], scenes_[scene]->skeleton);
}

/// Determines which scenes are visible, and where.
void Stage::look_around(const stream::PoseMoment& moment, const meshes::View& view) {
  const glm::vec3 to_sun(light_.to_sun);
  const std::array<glm::vec4, 5> planes = meshes::side_planes(view);
  for (std::size_t scene = 0; scene < views_.size(); ++scene) {
    const SceneRenderer& renderer = *views_[scene]->renderer;
    seen_[scene] = {};
    if (!is_there(moment, scene)) continue;
    const bool is_field = renderer.is_field();
    const meshes::Bounds box = with_room(views_[scene]->bounds);
    seen_[scene].in_picture = is_field || is_large_in_view(view, planes, box);
    if (!renderer.casts_shadow() || to_sun.y <= kMinSun) continue;
    // The shadow also falls on objects between the thing and the ground.
    const meshes::Bounds shadow = shadow_of(box, to_sun);
    seen_[scene].in_shadow = is_field || is_large_in_view(view, planes, united(box, shadow));
  }
  choose_mirror(view);
  if (!image_) return;
  const std::array<glm::vec4, 5> image_planes = meshes::side_planes(*image_);
  for (std::size_t scene = 0; scene < views_.size(); ++scene) {
    const SceneRenderer& renderer = *views_[scene]->renderer;
    if (!is_there(moment, scene) || renderer.is_field()) continue;
    if (quality_ == look::Quality::kLow && !renderer.mirror_m() && !renderer.throws_light()) continue;  // draw_mirror()
    seen_[scene].in_mirror = is_large_in_view(*image_, image_planes, with_room(views_[scene]->bounds));
  }
}

/// There is one mirror: for the water that is widest in the picture, and all water of the same height.
void Stage::choose_mirror(const meshes::View& view) {
  image_.reset();
  float widest_px = kMirrorFrom_px;
  std::optional<float> height_m;
  for (std::size_t scene = 0; scene < views_.size(); ++scene) {
    if (!seen_[scene].in_picture || !views_[scene]->renderer->mirror_m()) continue;
    const float width_px = half_width_px(view, views_[scene]->bounds);
    if (width_px <= widest_px) continue;
    widest_px = width_px;
    height_m = views_[scene]->renderer->mirror_m();
  }
  for (const auto& scene : views_) {
    const std::optional<float> own_m = scene->renderer->mirror_m();
    const bool is_as_high = own_m && height_m && std::abs(*own_m - *height_m) < kSameHeight_m;
    const float width_px = half_width_px(view, scene->bounds);
    scene->renderer->set_mirror_share(is_as_high ? glm::smoothstep(kMirrorFrom_px, kMirrorAll_px, width_px) : 0.0F);
  }
  if (!height_m) return;
  const int smaller = quality_ == look::Quality::kLow ? kLowMirror : kMirror;
  image_ = meshes::mirrored(view, *height_m, 1.0F / static_cast<float>(smaller));
}

/// Passes each renderer its pose, and gets the light that it throws.
void Stage::move_to(const stream::PoseMoment& moment) {
  const SceneRenderer::Moment now{.time_s = moment.time_s,
                                  .wind_m_s = wind_m_s_of(moment),
                                  .flame_brightness = light::flame_brightness(light_.air.x),
                                  .hanging_leaves = light_.leaves.w};
  fires_.clear();
  for (std::size_t scene = 0; scene < views_.size(); ++scene) {
    const Seen& seen = seen_[scene];
    SceneRenderer& renderer = *views_[scene]->renderer;
    if (!is_there(moment, scene) || !(seen.is_anywhere() || renderer.throws_light())) continue;
    renderer.set_moment(now);
    renderer.move_to(moment.poses[scene]);
    renderer.set_blade_share(blade_share_);
    if (std::optional<light::Fire> fire = renderer.fire()) {
      fire->light *= moment.opacities[scene];
      fires_.push_back(*fire);
    }
  }
}

/// Updates the things on the ground, and the bends of its grass.
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
  std::shared_ptr<const look::Image> image;
  float image_opacity = 0.0F;
  for (std::size_t scene = 0; scene < views_.size(); ++scene) {
    const SceneView& view = *views_[scene];
    const bool fits = scene < moment.poses.size() && scene < moment.opacities.size() &&
                      pose::fits(moment.poses[scene], scenes_[scene]->skeleton);
    if (view.renderer->is_ground()) {
      // It moves the grass around every scene, even if only another one is shown.
      if (!fits || moment.opacities[scene] <= 0.0F) continue;
      nodes = std::get_if<pose::StrandPose>(&moment.poses[scene]);
      grid = view.grid;
      ground_opacity = std::max(ground_opacity, moment.opacities[scene]);
      if (moment.opacities[scene] > image_opacity) {
        image = view.scene.cloth.image;
        image_opacity = moment.opacities[scene];
      }
      continue;
    }
    is_bare = is_bare && !is_chosen(scene);
    if (!is_there(moment, scene)) continue;
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
  // During the change from one image to another the bare ground is visible.
  landscape_.set_ground_image(image, std::clamp(2.0F * image_opacity - 1.0F, 0.0F, 1.0F));
  ground_.set_standing(standing_, light_.colors.z);
  ground_.set_moment(moment.time_s, wind_m_s_of(moment));
  ground_.move_to(grid, nodes, near_by, tall_);
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
  shadow_map_.reset();
}

/// Draws the sun's view of everything that casts a shadow, and sets `view` to use it.
void Stage::draw_shadow_map(const stream::PoseMoment& moment, const glm::vec3& to_sun, meshes::View& view) {
  const auto casts = [&](std::size_t scene) {
    return is_there(moment, scene) && views_[scene]->renderer->casts_shadow();
  };
  std::optional<meshes::Bounds> casters = around(casts);
  if (!casters) return;
  // Objects on a floor are blown out over it.
  for (std::size_t scene = 0; scene < views_.size(); ++scene) {
    if (!casts(scene)) continue;
    if (const auto floor = views_[scene]->renderer->floor()) casters = united(*casters, meshes::bounds_of(*floor));
  }
  if (!shadow_map_) shadow_map_.emplace(shadow_texels(quality_));
  const meshes::View shadows = meshes::shadow_view(*casters, to_sun, shadow_map_->texels());
  const float coarseness = quality_ == look::Quality::kLow ? coarseness_ * kShadowPixels : 1.0F;
  view_buffer_.set(shadows);
  view_buffer_.set(light_);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glDisable(GL_SCISSOR_TEST);
  shadow_map_->begin();
  for (std::size_t scene = 0; scene < views_.size(); ++scene) {
    if (!seen_[scene].in_shadow) continue;
    door_.open(moment.opacities[scene], scene);
    views_[scene]->renderer->draw_shadow(coarser(shadows, coarseness));
    door_.close();
  }
  shadow_map_->end();
  meshes::add_shadows(view, shadows, shadow_map_->texels());
}

/// Draws the mirror image for the water in view, with less detail than the picture.
void Stage::draw_mirror(const stream::PoseMoment& moment, const meshes::View& view, const gl::RenderTarget& target) {
  if (!image_) return;
  const int smaller = quality_ == look::Quality::kLow ? kLowMirror : kMirror;
  const int width_px = std::max(1, target.drawn_width_px() / smaller);
  const int height_px = std::max(1, target.drawn_height_px() / smaller);
  if (!mirror_ || mirror_->width_px() != width_px || mirror_->height_px() != height_px) {
    mirror_.reset();
    mirror_.emplace(width_px, height_px);
  }
  view_buffer_.set(*image_);
  mirror_->begin();
  for (std::size_t scene = 0; scene < views_.size(); ++scene) {
    // With low quality only the plants at the water, sky, hills and fires.
    if (!seen_[scene].in_mirror) continue;
    if (quality_ == look::Quality::kLow && !views_[scene]->renderer->mirror_m()) continue;
    door_.open(moment.opacities[scene], scene);
    views_[scene]->renderer->draw_mirrored(coarser(*image_, coarseness_));
    door_.close();
  }
  if (quality_ == look::Quality::kHigh || quality_ == look::Quality::kAuto) draw_sward(*image_);
  landscape_.draw_mirrored_sky(*image_);
  for (std::size_t scene = 0; scene < views_.size(); ++scene) {
    if (seen_[scene].in_mirror) views_[scene]->renderer->draw_light();
  }
  mirror_->end();
  view_buffer_.set(view);
  mark_pass("mirror");
}

void Stage::draw(const stream::PoseMoment& moment, const meshes::OrbitCamera& camera, gl::RenderTarget& target) {
  meshes::OrbitCamera from = camera;
  from.go_to(outside(camera.place()));
  meshes::View view = meshes::view_of(from, target.drawn_width_px(), target.drawn_height_px());
  if (marks_ != nullptr) marks_->begin();
  const glm::vec3 to_sun(light_.to_sun);
  const bool has_shadows = to_sun.y > kMinSun;
  look_around(moment, view);
  move_to(moment);
  view_buffer_.set(light::nearest_fires(fires_, glm::vec3(view.eye_m)));
  mark_pass("kinematics");
  view_buffer_.set(light_);
  for (std::size_t scene = 0; scene < views_.size(); ++scene) {
    if (seen_[scene].is_anywhere()) views_[scene]->renderer->prepare(view, view_buffer_);
  }
  meshes::View shadowed = view;  // for grass and ground
  if (has_shadows) {
    draw_shadow_map(moment, to_sun, shadowed);
    mark_pass("shadows");
  }
  if (quality_ == look::Quality::kLow) {
    shadowed = meshes::with_hard_shadows(shadowed);
  } else {
    view = shadowed;
  }
  view_buffer_.set(view);
  view_buffer_.set(light_);
  landscape_.prepare(light_, view, target.drawn_width_px(), target.drawn_height_px());
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glDisable(GL_SCISSOR_TEST);
  move_ground(moment);
  for (std::size_t scene = 0; scene < views_.size(); ++scene) {
    if (seen_[scene].is_anywhere()) views_[scene]->renderer->feel_ground(ground_);
  }
  mark_pass("ground maps");
  draw_mirror(moment, view, target);
  target.begin();
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
  for (std::size_t scene = 0; scene < views_.size(); ++scene) {
    SceneRenderer& renderer = *views_[scene]->renderer;
    if (!seen_[scene].in_picture) continue;
    door_.open(moment.opacities[scene], scene);
    if (renderer.is_field()) {
      view_buffer_.set(shadowed);
      renderer.draw(shadowed);
      view_buffer_.set(view);
    } else {
      renderer.draw(coarser(view, coarseness_));
    }
    door_.begin_mark(gl::kHole);
    renderer.draw_hole();
    door_.end_mark();
    mark_pass(scenes_[scene]->kind);
    door_.close();
  }
  view_buffer_.set(shadowed);
  draw_sward(shadowed);
  mark_pass("sward");
  landscape_.draw_ground();
  mark_pass("ground");
  view_buffer_.set(view);
  has_sky_ ? landscape_.draw_sky(view) : landscape_.draw_hills(view);
  mark_pass("hills and sky");
  for (std::size_t scene = 0; scene < views_.size(); ++scene) {
    // A fire lights places beyond its own box.
    const bool is_fire = is_there(moment, scene) && views_[scene]->renderer->throws_light();
    if (!seen_[scene].in_picture && !is_fire) continue;
    door_.open(moment.opacities[scene], scene);
    views_[scene]->renderer->draw_light();
    door_.close();
  }
  mark_pass("lights");
  target.resolve();
  mark_pass("resolving");
}

}  // namespace yuragi::viewer::looks
