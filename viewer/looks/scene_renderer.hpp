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

  /// What move_to() is to go by besides: the stream's time, the wind toward east and south, how bright flames are in
  /// the picture (light::flame_brightness), and the share of leaves that hang on trees. Called before it.
  struct Moment {
    double time_s = 0.0;
    glm::vec2 wind_m_s{0.0F};
    float flame_brightness = 1.0F;
    float hanging_leaves = 1.0F;
  };
  virtual void set_moment(const Moment&) {}

  /// Takes the pose of the next picture, which fits the skeleton. Called before anything is drawn; not where nothing of
  /// it is seen, unless it throws light.
  virtual void move_to(const pose::Pose& pose) = 0;

  /// Takes how the wind bends the grass around it in this picture. Called after move_to() and prepare(), if it is seen,
  /// with the maps bound and no framebuffer of the picture's: it may draw a picture of its own.
  virtual void feel_ground(const GroundMaps&) {}

  /// Draws pictures of its own that later ones are made of. Called before anything of a picture is drawn; `views` and
  /// the framebuffer are set again afterwards, and so are depth test, stencil test and blending.
  virtual void prepare(const meshes::View&, gl::ViewBuffer&) {}

  /// Draws the opaque parts. The View is bound (ViewBuffer::set); `view` may have larger pixels, where meshes are to be
  /// coarser. The stage has set depth and stencil tests; other
  /// OpenGL state that is changed here, but for bindings, is restored.
  virtual void draw(const meshes::View& view) = 0;

  /// Draws what casts its shadow, seen from the sun; it may be coarser.
  virtual void draw_shadow(const meshes::View& view) { draw(view); }

  /// Draws, after everything else, what is blended over it: flames.
  virtual void draw_light() {}

  /// Fills, in the stencil alone, the part of the ground that is open: under water.
  virtual void draw_hole() {}

  /// A camera's place, or one farther back, that is not within it.
  virtual meshes::CameraPlace outside(const meshes::CameraPlace& place) const { return place; }

  /// Does it light what is around it?
  virtual bool throws_light() const { return false; }

  /// The light that it throws on what is around it, after move_to().
  virtual std::optional<light::Fire> fire() const { return std::nullopt; }

  /// `bounds`, of its skeleton, and what holds that, but not the floor.
  virtual meshes::Bounds bounds_with_holder(const meshes::Bounds& bounds) const { return bounds; }

  /// The floor on which it stands, where it has one of its own.
  virtual std::optional<meshes::Floor> floor() const { return std::nullopt; }

  /// From now on it draws only this share (0 to 1] of the blades of grass that it would.
  virtual void set_blade_share(float) {}

  /// The height of the level mirror that it is, metres; nothing where it is none.
  virtual std::optional<float> mirror_m() const { return std::nullopt; }

  /// So much of what it mirrors (0 to 1) is in the mirror of the next picture; in place of the rest it mirrors clear
  /// sky.
  virtual void set_mirror_share(float) {}

  /// Draws what is seen of it in a mirror.
  virtual void draw_mirrored(const meshes::View& view) { draw(view); }

  /// Does it cast a shadow? Then draw_shadow() is called with a View from the sun.
  virtual bool casts_shadow() const { return false; }

  /// Does it cover the ground as a field, in which the camera stands?
  virtual bool is_field() const { return false; }

  /// Is it no thing, but the bends of the grass on all of the ground around?
  virtual bool is_ground() const { return false; }
};

/// The renderer for the scene's kind of skeleton, and for the scene's own kind where there are several. `scene` must
/// outlive it.
std::unique_ptr<SceneRenderer> make_scene_renderer(const wire::SceneModel& scene, look::Quality quality);

}  // namespace yuragi::viewer::looks
