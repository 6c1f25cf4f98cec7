#pragma once

#include "viewer/gl/gl.hpp"

namespace yuragi::viewer::gl {

/// Darkens a whole picture. Needs a current context.
class Dimmer {
 public:
  Dimmer();

  /// Multiplies the colors (sRGB values) of the framebuffer that is bound by `brightness`, 0: black, to 1: unchanged.
  void draw(float brightness);

 private:
  Program program_;
  VertexArray no_attributes_;
};

}  // namespace yuragi::viewer::gl
