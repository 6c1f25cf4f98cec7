#pragma once

#include <optional>
#include <string>
#include <vector>

#include "viewer/light/sky_keeper.hpp"
#include "viewer/picture/camera_keeper.hpp"
#include "viewer/picture/camera_view.hpp"
#include "viewer/picture/renderer.hpp"
#include "viewer/picture/viewer_options.hpp"

namespace yuragi::viewer::picture {

/// What the pictures of a stream show, by the sender's values and the command line's: scenes, light, camera.
/// Pure but for the renderer: time is a parameter. Thread-safe: no.
class Director {
 public:
  /// `source`: who sends the stream, for people. Both others must outlive this.
  Director(const ViewerOptions& options, Renderer& renderer, std::string source);

  /// Where the sender's wind usually comes from, before its scenes: the first view looks across it.
  void set_wind_from(double wind_from_deg) { wind_from_deg_ = wind_from_deg; }
  /// Throws ViewerExit where the first ones are without the one that was asked for.
  void set_scenes(std::vector<wire::SceneModel> scenes);
  /// Light, which fades over `fade_s`, and cameras. Throws ViewerExit where the first are without the camera that was
  /// asked for.
  void take_status(const wire::Sensors& status, double fade_s = light::SkyKeeper::kFade_s);
  /// Does the command line ask for one of the sender's cameras?
  bool is_camera_named() const { return !options_.camera.empty() && !view_; }
  /// Throws ViewerExit where the sender does not have it.
  void require_camera() const;

  /// The camera by hand, which begins where the picture is.
  meshes::OrbitCamera& take_camera();
  /// On to the next of the sender's cameras.
  void show_next_camera() { cameras_.next(); }
  /// That camera of the sender's, from 1.
  void show_camera(std::size_t number) { cameras_.show(number); }
  /// The camera by hand at its first place.
  void show_home();
  /// The next quality, regardless of the look: low, medium, high, and low again. `present`: what is drawn.
  void show_next_quality(look::Quality present);
  void reset_camera();
  /// After the choice of scenes: the camera by hand at its first place for them, or, where all are drawn, the first
  /// camera.
  void frame_scenes(bool are_all);

  /// Advances by passed_s. `utc_s`: the sender's clock, as its newest frame has it; 0 before the first.
  void advance(double passed_s, double utc_s, const wind::Vector& wind);
  void draw(const stream::PoseMoment& moment);

  /// What the last picture showed.
  const look::Look& look() const { return sky_.look(); }
  double heading_deg() const { return place_for(cameras_.now()).heading_deg; }
  /// Does a camera's picture pass into another's? Then both are drawn.
  bool is_fading() const { return cameras_.is_fading(); }
  /// "camera evening, cross-fading"; empty where the sender has none.
  std::string camera_text() const;

 private:
  void frame();
  void follow_aspect();
  meshes::CameraPlace first_place();
  look::Look look_for(const look::Look& senders) const;
  meshes::CameraPlace place_for(const Shot& shot) const;
  void require_scene() const;

  const ViewerOptions& options_;
  Renderer& renderer_;
  const std::string source_;
  const std::optional<CameraView> view_;  // of the command line
  CameraKeeper cameras_;
  meshes::OrbitCamera camera_;  // by hand
  light::SkyKeeper sky_;
  std::optional<look::Quality> quality_;  // that a person has chosen
  double utc_s_ = 0.0;
  std::optional<double> view_wind_from_deg_;  // of the last moment
  double framed_aspect_ = 0.0;
  double wind_from_deg_ = meshes::kUsualWindFrom_deg;
  bool has_scenes_ = false;
  bool has_status_ = false;
};

}  // namespace yuragi::viewer::picture
