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

/// Decides what the pictures of a stream show, by the sender's values and the command line's: scenes, light, camera.
/// Pure except for the renderer: time is a parameter. Thread-safe: no.
class Director {
 public:
  /// `source`: the stream's sender, for people. Both others must outlive this.
  Director(const ViewerOptions& options, Renderer& renderer, std::string source);

  /// The sender's usual wind direction; set before its scenes, because the first view looks across it.
  void set_wind_from(double wind_from_deg) { wind_from_deg_ = wind_from_deg; }
  /// Throws ViewerExit if the first ones do not include the requested one.
  void set_scenes(std::vector<wire::SceneModel> scenes);
  /// Takes light, which fades over `fade_s`, and cameras. Throws ViewerExit if the first ones do not include the
  /// requested camera.
  void take_status(const wire::Sensors& status, double fade_s = light::SkyKeeper::kFade_s);
  /// Returns true if the command line names one of the sender's cameras.
  bool is_camera_named() const { return !options_.camera.empty() && !view_; }
  /// Throws ViewerExit if the sender does not have it.
  void require_camera() const;

  /// Returns the camera by hand, which starts at the present view.
  meshes::OrbitCamera& take_camera();
  /// Shows the next of the sender's cameras.
  void show_next_camera() { cameras_.next(); }
  /// Shows that camera of the sender, from 1.
  void show_camera(std::size_t number) { cameras_.show(number); }
  /// The camera by hand at its first place.
  void show_home();
  /// Shows the next quality, regardless of the look: low, medium, high, and low again. `present`: the one that is
  /// drawn.
  void show_next_quality(look::Quality present);
  void reset_camera();
  /// Call after the choice of scenes: moves the camera by hand to its first place for them, or, if all are drawn, shows
  /// the first camera.
  void frame_scenes(bool are_all);

  /// Advances by passed_s. `utc_s`: the sender's clock, from its newest frame; 0 before the first.
  void advance(double passed_s, double utc_s, const wind::Vector& wind);
  void draw(const stream::PoseMoment& moment);

  /// The look of the last picture.
  const look::Look& look() const { return sky_.look(); }
  double heading_deg() const { return place_for(cameras_.now()).heading_deg; }
  /// Returns true during a cross-fade between two cameras. Then both are drawn.
  bool is_fading() const { return cameras_.is_fading(); }
  /// "camera evening, cross-fading"; empty if the sender has none.
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
