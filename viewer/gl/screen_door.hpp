#pragma once

#include "viewer/gl/gl.hpp"

namespace yuragi {

// The bits of the stencil while the stage draws.
inline constexpr GLuint kBehindDoor = 1;  ///< this pixel is not drawn on by the scene that fades
inline constexpr GLuint kHole = 2;        ///< the ground is open here
inline constexpr GLuint kShadow = 4;      ///< the ground is in a shadow here

/// Fades a scene without sorting and without its shaders knowing of it: as if through a fly screen, it is drawn on a
/// share of the pixels only. Needs a current context and a stencil.
class ScreenDoor {
 public:
  ScreenDoor();

  /// What is drawn from here on to close() falls on `opacity` (0 to 1) of the pixels, evenly spread; on others for each
  /// `number`.
  void open(float opacity, std::size_t number);
  /// What is drawn from here on to end_mark() is not seen, but sets a bit, wherever it would fall, behind something or
  /// not. While the door is open.
  void begin_mark(GLuint bit);
  void end_mark();
  void close();

 private:
  void draw_on_open();

  GlProgram program_;
  GLint opacity_place_ = -1;
  GLint number_place_ = -1;
  GlVertexArray no_attributes_;
  bool is_half_open_ = false;
};

}  // namespace yuragi
