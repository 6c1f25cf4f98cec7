#pragma once

#include "viewer/gl.hpp"

namespace yuragi {

/// The ground and the evening sky around what sways. Drawn last: what is covered is not painted. Needs a current
/// context.
class Landscape {
 public:
  Landscape();

  /// The View is bound (ViewBuffer::set).
  void draw();

 private:
  GlTexture noise_;
  GlProgram ground_;
  GlProgram hills_;
  GlProgram sky_;
  GlVertexArray no_attributes_;
};

}  // namespace yuragi
