#pragma once

#include "viewer/gl/gl.hpp"
#include "viewer/gl/picture_copy.hpp"
#include "viewer/gl/render_target.hpp"

namespace yuragi::viewer::gl {

/// Smooths edges in a finished picture of one sample a pixel, and details finer than a pixel, so that they do not
/// flicker while the camera or the wind moves (T. Lottes 2009, "FXAA"). One pass. Needs a current context.
class EdgeSmoother {
 public:
  EdgeSmoother();

  /// Replaces the resolved pixels of `target`, which stay bound.
  void draw(const RenderTarget& target);

 private:
  Program program_;
  VertexArray no_attributes_;
  PictureCopy copy_{GL_LINEAR};
};

}  // namespace yuragi::viewer::gl
