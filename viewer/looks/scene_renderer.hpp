#pragma once

#include <memory>
#include <optional>

#include <glm/vec2.hpp>

#include "engine/look/look.hpp"
#include "engine/wire/wire.hpp"
#include "viewer/gl/view_buffer.hpp"
#include "viewer/light/fire_light.hpp"
#include "viewer/meshes/bounds.hpp"
#include "viewer/meshes/floor.hpp"
#include "viewer/meshes/orbit_camera.hpp"
#include "viewer/meshes/view.hpp"

namespace yuragi::viewer::looks {

class GroundMaps;

/// The renderer of a scene view. Owns its GPU objects; needs a current context; on its thread. Allocates nothing from
/// picture to picture after the first few.
class SceneRenderer {
 public:
  SceneRenderer() = default;
  virtual ~SceneRenderer() = default;
  SceneRenderer(const SceneRenderer&) = delete;
  SceneRenderer& operator=(const SceneRenderer&) = delete;

  /// Further input of move_to(): the stream's time, the wind toward east and south, the brightness of flames in the
  /// picture (light::flame_brightness), and the share of leaves on trees. Set before it.
  struct Moment {
    double time_s = 0.0;
    glm::vec2 wind_m_s{0.0F};
    float flame_brightness = 1.0F;
    float hanging_leaves = 1.0F;
  };
  virtual void set_moment(const Moment&) {}

  /// Takes the pose of the next picture, which fits the skeleton. Called before anything is drawn; not called if it is
  /// invisible, unless it throws light.
  virtual void move_to(const pose::Pose& pose) = 0;

  /// Takes how the wind bends the grass around it in this picture. Called after move_to() and prepare(), if it is
  /// visible, with the maps bound and none of the picture's framebuffers: it can draw a picture of its own.
  virtual void feel_ground(const GroundMaps&) {}

  /// Draws its own auxiliary pictures. Called before anything of a picture is drawn; `views` and the framebuffer are
  /// set again afterwards, and so are depth test, stencil test and blending.
  virtual void prepare(const meshes::View&, gl::ViewBuffer&) {}

  /// Draws the opaque parts. The View is bound (ViewBuffer::set); `view` can have larger pixels, if meshes are to be
  /// coarser. The stage has set depth and stencil tests; other OpenGL state that is changed here, except bindings, is
  /// restored.
  virtual void draw(const meshes::View& view) = 0;

  /// Draws its shadow, seen from the sun; it can be coarser.
  virtual void draw_shadow(const meshes::View& view) { draw(view); }

  /// Draws, after everything else, the parts that are blended over it: flames.
  virtual void draw_light() {}

  /// Fills, in the stencil alone, the part of the ground that is open: under water.
  virtual void draw_hole() {}

  /// A camera's place, or one farther back, that is not within it.
  virtual meshes::CameraPlace outside(const meshes::CameraPlace& place) const { return place; }

  /// Returns true if it lights its surroundings.
  virtual bool throws_light() const { return false; }

  /// The light that it throws on its surroundings, after move_to().
  virtual std::optional<light::Fire> fire() const { return std::nullopt; }

  /// Bounds of its skeleton (`bounds`) and its holder, without the floor.
  virtual meshes::Bounds bounds_with_holder(const meshes::Bounds& bounds) const { return bounds; }

  /// The floor on which it stands, if it has one of its own.
  virtual std::optional<meshes::Floor> floor() const { return std::nullopt; }

  /// From now on draws only this share (0 to 1] of its blades of grass.
  virtual void set_blade_share(float) {}

  /// The height of the level mirror that it is, metres; nullopt if it is not a mirror.
  virtual std::optional<float> mirror_m() const { return std::nullopt; }

  /// This share (0 to 1) of its mirror image is in the mirror of the next picture; for the rest it mirrors clear sky.
  virtual void set_mirror_share(float) {}

  /// Draws its image in a mirror.
  virtual void draw_mirrored(const meshes::View& view) { draw(view); }

  /// Returns true if it casts a shadow: then draw_shadow() is called with a View from the sun.
  virtual bool casts_shadow() const { return false; }

  /// Returns true if it covers the ground as a field, in which the camera stands.
  virtual bool is_field() const { return false; }

  /// Returns true if it is not an object, but the bends of the grass on all of the ground.
  virtual bool is_ground() const { return false; }
};

/// Returns the renderer for the scene's kind of skeleton, or for the scene's own kind if there are several. `scene`
/// must outlive it.
std::unique_ptr<SceneRenderer> make_scene_renderer(const wire::SceneModel& scene, look::Quality quality);

}  // namespace yuragi::viewer::looks
