#pragma once

#include <memory>

#include "engine/wire/wire.hpp"
#include "viewer/meshes/view.hpp"

namespace yuragi {

/// How a scene is drawn. Owns its GPU objects; needs a current context; on its thread. Allocates nothing from picture
/// to picture once it has drawn the first few.
class Look {
 public:
  Look() = default;
  virtual ~Look() = default;
  Look(const Look&) = delete;
  Look& operator=(const Look&) = delete;

  /// Takes a pose that fits the skeleton; before anything is drawn, and for each picture.
  virtual void move_to(const Pose& pose) = 0;

  /// Draws what stands there. The View is bound (ViewBuffer::set). The stage has set depth and stencil tests; what a
  /// look changes of OpenGL's state besides bindings it sets back.
  virtual void draw(const View& view) = 0;

  /// Draws, after everything else, what shines through: flames.
  virtual void draw_light() {}

  /// Fills, into the stencil alone, where the ground is open: under water.
  virtual void draw_hole() {}

  /// Does it stand in the sun's way? Then draw() is also called with a View that lays everything flat on the ground.
  virtual bool casts_shadow() const { return false; }

  /// Does it cover the ground as a field that one stands in?
  virtual bool is_field() const { return false; }
};

/// The look for the scene's kind of skeleton, and its own kind where there are several. `scene` must outlive it.
std::unique_ptr<Look> make_look(const wire::SceneModel& scene);

}  // namespace yuragi
