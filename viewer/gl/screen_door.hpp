#pragma once

#include "viewer/gl/gl.hpp"

namespace yuragi::viewer::gl {

// The bits of the stencil while the stage draws.
inline constexpr GLuint kBehindDoor = 1;  ///< the scene that fades does not draw on this pixel
inline constexpr GLuint kHole = 2;        ///< the ground is open here

/// Screen-door transparency: fades a scene by drawing it on a share of the pixels only, so that nothing has to be
/// sorted by depth and its shaders do not change. Needs a current context and a stencil.
class ScreenDoor {
 public:
  ScreenDoor();

  /// What is drawn until close() covers the share `opacity` (0 to 1) of the pixels, evenly spread; `number` selects
  /// which ones.
  void open(float opacity, std::size_t number);
  /// What is drawn until end_mark() is invisible, but sets `bit` in the stencil of every pixel that it covers, occluded
  /// or not. Only between open() and close().
  void begin_mark(GLuint bit);
  void end_mark();
  void close();

 private:
  void draw_on_open();

  Program program_;
  GLint opacity_place_ = -1;
  GLint number_place_ = -1;
  VertexArray no_attributes_;
  bool is_half_open_ = false;
};

}  // namespace yuragi::viewer::gl
