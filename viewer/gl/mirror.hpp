#pragma once

#include "viewer/gl/gl.hpp"

namespace yuragi::viewer::gl {

/// The picture of a level mirror, as a texture with coarser levels, on the unit kMirrorUnit. With a stencil, for
/// ScreenDoor. Needs a current context. Throws std::runtime_error if the driver cannot make it.
class Mirror {
 public:
  Mirror(int width_px, int height_px);

  int width_px() const { return width_px_; }
  int height_px() const { return height_px_; }

  /// From now on draws into the mirror.
  void begin();
  /// The mirror can now be used; the caller binds the next framebuffer.
  void end();

 private:
  int width_px_, height_px_;
  Texture color_;
  Renderbuffer depth_;
  Framebuffer framebuffer_;
};

}  // namespace yuragi::viewer::gl
