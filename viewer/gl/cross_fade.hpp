#pragma once

#include "viewer/gl/gl.hpp"
#include "viewer/gl/picture_copy.hpp"
#include "viewer/gl/render_target.hpp"

namespace yuragi::viewer::gl {

/// Mixes two whole pictures, in linear light. Needs a current context.
class CrossFade {
 public:
  CrossFade();

  /// Keeps a copy of the resolved pixels of `target`: the picture that fades out.
  void keep(const RenderTarget& target);

  /// Mixes the kept picture with the resolved pixels of `target`, which has the same size: 0, only the kept one, to 1,
  /// only `target`.
  void draw(const RenderTarget& target, float share);

 private:
  Program program_;
  VertexArray no_attributes_;
  GLint share_;
  PictureCopy before_{GL_NEAREST}, now_{GL_NEAREST};
};

}  // namespace yuragi::viewer::gl
