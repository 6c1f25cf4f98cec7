#pragma once

#include <optional>
#include <string>
#include <vector>

#include "viewer/camera_keeper.hpp"
#include "viewer/light/sky_keeper.hpp"
#include "viewer/options.hpp"
#include "viewer/renderer.hpp"

namespace yuragi::viewer {

/// What the pictures of a stream show, of what the sender says and the command line asks for: scenes, light, camera.
/// Pure but for the renderer: time is a parameter. Thread-safe: no.
class PictureDirector {
 public:
  /// `source`: who sends the stream, for people. Both others must outlive this.
  PictureDirector(const ViewerOptions& options, Renderer& renderer, std::string source);

  /// Throws ViewerExit where the first ones are without the one that was asked for.
  void set_scenes(std::vector<wire::SceneModel> scenes);
  /// Light and cameras. Throws ViewerExit where the first are without the camera that was asked for.
  void take_status(const wire::Sensors& status);

  /// Advances by passed_s to utc_s, the sender's clock.
  void advance(double passed_s, double utc_s, const wind::WindVector& wind);
  void draw(const stream::PoseMoment& moment);

 private:
  look::Look look_for(const look::Look& senders) const;
  meshes::CameraPlace place_for(const Shot& shot) const;
  void require_scene() const;
  void require_camera() const;

  const ViewerOptions& options_;
  Renderer& renderer_;
  const std::string source_;
  const std::optional<CameraView> view_;  // of the command line
  const double aspect_;
  CameraKeeper cameras_;
  meshes::OrbitCamera camera_;  // where none is the sender's
  light::SkyKeeper sky_;
  bool has_scenes_ = false;
  bool has_status_ = false;
};

}  // namespace yuragi::viewer
