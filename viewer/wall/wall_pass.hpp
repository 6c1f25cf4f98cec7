#pragma once

#include "engine/output/output.hpp"
#include "viewer/gl/gl.hpp"
#include "viewer/gl/picture_copy.hpp"
#include "viewer/gl/render_target.hpp"

namespace yuragi::viewer::wall {

/// The last pass: a window's crop of the picture, rotated, straightened and blended, onto its monitor. One for all
/// windows, whose contexts share it; take() in the context that made it, draw() in each window's.
class Pass {
 public:
  Pass();

  /// Takes the resolved pixels of `target`.
  void take(const gl::RenderTarget& target);

  /// Fills the framebuffer that is bound, of this size; black outside of the picture. `vertex_array`: any of the
  /// current context, since contexts do not share them. `is_marked`: with the crop's border and its strips.
  void draw(const output::Window& window, const output::Size& monitor, GLuint vertex_array, bool is_marked);

 private:
  gl::Program program_;
  gl::PictureCopy picture_{GL_LINEAR};
  GLint monitor_px_, to_crop_, crop_, blend_, gamma_, is_marked_;
};

}  // namespace yuragi::viewer::wall
