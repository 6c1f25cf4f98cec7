#pragma once

#include "viewer/gl/gl.hpp"
#include "viewer/gl/render_target.hpp"

namespace yuragi::viewer::gl {

/// Mixes two whole pictures, as their lights mix. Needs a current context.
class CrossFade {
 public:
  CrossFade();

  /// Keeps a copy of the resolved pixels of `target`: the picture that fades out.
  void keep(const RenderTarget& target);

  /// Mixes the picture that was kept with the resolved pixels of `target`, which has the same size: 0, the one that was
  /// kept, to 1, the other.
  void draw(const RenderTarget& target, float share);

 private:
  struct Copy {
    GlTexture texture;
    int width_px = 0;
    int height_px = 0;
  };
  static void take(Copy& copy, const RenderTarget& target);

  GlProgram program_;
  GlVertexArray no_attributes_;
  GLint share_;
  Copy before_, now_;
};

}  // namespace yuragi::viewer::gl
