#pragma once

#include "viewer/gl/gl.hpp"

namespace yuragi::viewer::looks {

/// The ground and the evening sky around the scenes. Drawn after them, so that what they cover is not painted. Needs a
/// current context.
class Landscape {
 public:
  Landscape();

  /// The View (ViewBuffer::set) and the GroundMaps are bound. The ground has holes and shadows where the stencil has
  /// kHole and kShadow.
  void draw();
  /// The hills and the sky alone.
  void draw_sky();

 private:
  gl::GlTexture noise_;
  gl::GlProgram ground_;
  GLint sunlight_place_ = -1;
  gl::GlProgram hills_;
  gl::GlProgram sky_;
  gl::GlVertexArray no_attributes_;
};

}  // namespace yuragi::viewer::looks
