#pragma once

#include "viewer/gl/gl.hpp"

namespace yuragi::viewer::gl {

/// What a level mirror shows, as a texture with coarser and coarser levels, on the unit kMirrorUnit. With a stencil,
/// for ScreenDoor. Needs a current context. Throws std::runtime_error where the driver cannot make it.
class Mirror {
 public:
  Mirror(int width_px, int height_px);

  int width_px() const { return width_px_; }
  int height_px() const { return height_px_; }

  /// What is drawn from now on goes into the mirror.
  void begin();
  /// It can be looked up; the framebuffer to draw into is the caller's to bind.
  void end();

 private:
  int width_px_, height_px_;
  Texture color_;
  Renderbuffer depth_;
  Framebuffer framebuffer_;
};

}  // namespace yuragi::viewer::gl
