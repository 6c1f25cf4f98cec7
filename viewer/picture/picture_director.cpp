#include "viewer/picture/picture_director.hpp"

#include <utility>

#include "viewer/picture/camera_place.hpp"
#include "viewer/picture/viewer_exit.hpp"

namespace yuragi::viewer::picture {

Director::Director(const ViewerOptions& options, Renderer& renderer, std::string source)
    : options_(options), renderer_(renderer), source_(std::move(source)), view_(read_camera_view(options.camera)) {
  // The command line takes precedence over the hour.
  if (is_camera_named()) {
    cameras_.begin_with(options.camera);
  } else if (view_ || !options.scene.empty() || options.is_turning) {
    cameras_.begin_by_hand();
  }
  camera_.set_turning(options.is_turning);
  sky_.start(look_for({}));
  if (!options.scene.empty()) renderer_.show_only(options.scene);
  frame();
}

void Director::set_scenes(std::vector<wire::SceneModel> scenes) {
  renderer_.set_scenes(std::move(scenes));
  if (std::exchange(has_scenes_, true)) return;
  require_scene();
  frame();
}

void Director::frame() {
  camera_.frame(first_place());
}

/// The window's shape has changed: the first place changes; the camera moves only if it was there.
void Director::follow_aspect() {
  if (renderer_.aspect() != framed_aspect_) camera_.move_home(first_place());
}

meshes::CameraPlace Director::first_place() {
  framed_aspect_ = renderer_.aspect();
  meshes::CameraPlace place = renderer_.home(wind_from_deg_);
  if (view_) {
    place.heading_deg = view_->heading_deg;
    place.pitch_deg = view_->pitch_deg;
    place.distance_m = view_->distance_m;
  }
  return place;
}

void Director::take_status(const wire::Sensors& status, double fade_s) {
  const bool is_first = !std::exchange(has_status_, true);
  is_first ? sky_.start(look_for(status.look)) : sky_.set_look(look_for(status.look), fade_s);
  cameras_.set_cameras(status.cameras, status.camera);
  if (is_first) require_camera();
}

meshes::OrbitCamera& Director::take_camera() {
  if (cameras_.now().camera) camera_.go_to(place_for(cameras_.now()));
  cameras_.take_by_hand();
  return camera_;
}

void Director::show_home() {
  cameras_.take_by_hand();
  camera_.reset();
}

void Director::show_next_quality(look::Quality present) {
  switch (quality_.value_or(present)) {
    case look::Quality::kLow:
      quality_ = look::Quality::kMedium;
      break;
    case look::Quality::kMedium:
      quality_ = look::Quality::kHigh;
      break;
    case look::Quality::kHigh:
    case look::Quality::kAuto:
      quality_ = look::Quality::kLow;
      break;
  }
}

void Director::reset_camera() {
  if (!cameras_.reset()) camera_.reset();
}

void Director::frame_scenes(bool are_all) {
  cameras_.take_by_hand();
  frame();
  if (are_all) cameras_.reset();
}

void Director::advance(double passed_s, double utc_s, const wind::Vector& wind) {
  follow_aspect();
  cameras_.advance(passed_s);
  if (utc_s != std::exchange(utc_s_, utc_s)) cameras_.hear_clock(utc_s);
  camera_.advance(passed_s);
  camera_.keep_away(renderer_.outside(camera_.place()).distance_m);
  renderer_.set_light(sky_.advance(utc_s, passed_s, {wind.u_m_s, -wind.v_m_s}));
  const look::Look& look = sky_.look();
  renderer_.set_quality(quality_.value_or(look.quality), static_cast<float>(look.density));
}

void Director::draw(const stream::PoseMoment& moment) {
  view_wind_from_deg_ = moment.view_wind_from_deg;
  Picture picture{.moment = moment, .camera = place_for(cameras_.now())};
  if (cameras_.is_fading()) {
    picture.fading_out = place_for(cameras_.before());
    picture.share = static_cast<float>(cameras_.share());
  }
  renderer_.draw(picture);
}

std::string Director::camera_text() const {
  if (cameras_.cameras().empty()) return {};
  const std::string name = cameras_.now().name();
  const std::string fading = cameras_.is_fading() ? ", cross-fading" : "";
  return (name.empty() ? "camera by hand" : "camera " + name) + fading;
}

look::Look Director::look_for(const look::Look& senders) const {
  return *look::edited(senders, options_.look);
}

meshes::CameraPlace Director::place_for(const Shot& shot) const {
  if (!shot.camera) return camera_.place();
  return place_of(*shot.camera, renderer_.bounds_of(shot.camera->scene), renderer_.aspect(), shot.utc_s,
                  view_wind_from_deg_, renderer_.obstacles());
}

void Director::require_scene() const {
  if (options_.scene.empty()) return;
  std::string names;
  for (const wire::SceneModel* scene : renderer_.scenes()) {
    if (scene->name == options_.scene) return;
    names += names.empty() ? scene->name : ", " + scene->name;
  }
  throw ViewerExit(EX_USAGE, "--scene: " + source_ + " has no scene '" + options_.scene + "'; it has: " + names);
}

void Director::require_camera() const {
  if (!is_camera_named() || cameras_.has(options_.camera)) return;
  std::string names;
  for (const look::Camera& camera : cameras_.cameras()) names += names.empty() ? camera.name : ", " + camera.name;
  throw ViewerExit(EX_USAGE, "--camera: " + source_ + " has no camera '" + options_.camera + "'; it has " +
                                 (names.empty() ? "none: there is no [[camera]] in its configuration" : names));
}

}  // namespace yuragi::viewer::picture
