#pragma once

#include "viewer/gl/gl.hpp"

namespace yuragi::viewer::gl {

/// How far from the sun the nearest thing is, over a square. Shaders look it up by sunlight_at() (common.glsl). With a
/// stencil, for ScreenDoor. Needs a current context. Throws std::runtime_error where the driver cannot make it.
class ShadowMap {
 public:
  explicit ShadowMap(int texels);

  int texels() const { return texels_; }

  /// What is drawn from now on goes into the map.
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
