#pragma once

#include "engine/output/output.hpp"
#include "viewer/gl/gl.hpp"

namespace yuragi::viewer::wall {

/// A picture for setting up a wall: lines, circles, greys. Needs a current context.
class TestCard {
 public:
  TestCard();

  /// Fills the framebuffer that is bound, of this size.
  void draw(const output::Size& size);

 private:
  gl::Program program_;
  gl::VertexArray no_attributes_;
  GLint picture_px_;
};

}  // namespace yuragi::viewer::wall
