#pragma once

#include "viewer/gl/gl.hpp"
#include "viewer/gl/render_target.hpp"

namespace yuragi::viewer::gl {

/// A copy of a finished picture, for lookups while another is drawn. Needs a current context.
class PictureCopy {
 public:
  /// `filter`: GL_NEAREST or GL_LINEAR.
  explicit PictureCopy(GLint filter) : filter_(filter) {}

  /// Copies the resolved pixels of `target`, which stay bound. The copy stays bound to the texture unit that is active.
  void take(const RenderTarget& target);

  GLuint texture() const { return texture_.name(); }

 private:
  Texture texture_;
  GLint filter_;
  int width_px_ = 0;
  int height_px_ = 0;
};

}  // namespace yuragi::viewer::gl
