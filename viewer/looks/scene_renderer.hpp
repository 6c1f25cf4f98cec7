#pragma once

#include <memory>
#include <optional>

#include <glm/vec2.hpp>

#include "engine/look/look.hpp"
#include "engine/wire/wire.hpp"
#include "viewer/light/fire_light.hpp"
#include "viewer/meshes/view.hpp"

namespace yuragi::viewer::looks {

/// The renderer of a scene view. Owns its GPU objects; needs a current context; on its thread. Allocates nothing from
/// picture to picture after the first few.
class SceneRenderer {
 public:
  SceneRenderer() = default;
  virtual ~SceneRenderer() = default;
  SceneRenderer(const SceneRenderer&) = delete;
  SceneRenderer& operator=(const SceneRenderer&) = delete;

  /// What move_to() is to go by besides: the stream's time, the wind toward east and south, and how bright flames are
  /// in the picture (light::flame_brightness). Called before it.
  struct Moment {
    double time_s = 0.0;
    glm::vec2 wind_m_s{0.0F};
    float flame_brightness = 1.0F;
  };
  virtual void set_moment(const Moment&) {}

  /// Takes the pose of the next picture, which fits the skeleton. Called before anything is drawn.
  virtual void move_to(const pose::Pose& pose) = 0;

  /// Draws the opaque parts. The View is bound (ViewBuffer::set). The stage has set depth and stencil tests; other
  /// OpenGL state that is changed here, but for bindings, is restored.
  virtual void draw(const meshes::View& view) = 0;

  /// Draws, after everything else, what is blended over it: flames.
  virtual void draw_light() {}

  /// Fills, in the stencil alone, the part of the ground that is open: under water.
  virtual void draw_hole() {}

  /// The light that it throws on what is around it, after move_to().
  virtual std::optional<light::Fire> fire() const { return std::nullopt; }

  /// Does it cast a shadow? Then draw() is also called with a View that projects everything onto the ground.
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
