#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/look/look.hpp"
#include "viewer/light/light.hpp"
#include "viewer/meshes/bounds.hpp"
#include "viewer/meshes/orbit_camera.hpp"
#include "viewer/stream/pose_moment.hpp"

namespace yuragi::viewer::picture {

/// The content of a picture, and its camera.
struct Picture {
  const stream::PoseMoment& moment;
  meshes::CameraPlace camera;
  std::optional<meshes::CameraPlace> fading_out = {};  ///< place of another camera that fades out
  float share = 1.0F;                                  ///< of `camera`, during the cross-fade
};

/// Draws scenes into pictures of one size. Thread-safe: no.
class Renderer {
 public:
  virtual ~Renderer() = default;

  /// The scenes of the moments that follow.
  virtual void set_scenes(std::vector<wire::SceneModel> scenes) = 0;
  virtual const std::vector<const wire::SceneModel*>& scenes() const = 0;
  /// Draws only the scene of this name.
  virtual void show_only(const std::string& scene) = 0;

  /// Width / height of the pictures.
  virtual double aspect() const = 0;
  /// The camera's first place for the drawn scenes, across a wind from `wind_from_deg`.
  virtual meshes::CameraPlace home(double wind_from_deg) const = 0;
  /// Returns the place, moved back along its view if it is within an animal.
  virtual meshes::CameraPlace outside(const meshes::CameraPlace& place) const = 0;
  /// The box around the scene of this name; nullopt if there is none.
  virtual std::optional<meshes::Bounds> bounds_of(std::string_view scene) const = 0;

  /// The boxes around obstacles for a camera: all scenes except grass, ground and water.
  virtual std::vector<meshes::Bounds> obstacles() const { return {}; }

  virtual void set_light(const light::Light& light) = 0;
  /// `density`: of the blades of grass, the share (0 to 1] that is drawn.
  virtual void set_quality(look::Quality quality, float density) = 0;

  virtual void draw(const Picture& picture) = 0;
  /// The last picture: 3 bytes a pixel, rows from the top down.
  virtual std::vector<std::uint8_t> read_rgb() = 0;
};

}  // namespace yuragi::viewer::picture
