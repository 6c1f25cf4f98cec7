#pragma once

#include "viewer/gl/gl.hpp"

namespace yuragi::viewer::gl {

/// The distance from the sun to the nearest surface, over a square. Shaders use it through sunlight_at() (common.glsl).
/// With a stencil, for ScreenDoor. Needs a current context. Throws std::runtime_error if the driver cannot make it.
class ShadowMap {
 public:
  explicit ShadowMap(int texels);

  int texels() const { return texels_; }

  /// From now on draws into the map.
  void begin();
  /// The map can be looked up; the framebuffer to draw into is the caller's to bind.
  void end();

 private:
  int texels_;
  Texture depth_;
  Sampler compared_;
  Sampler plain_;
  Framebuffer framebuffer_;
};

}  // namespace yuragi::viewer::gl
