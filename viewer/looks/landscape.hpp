#pragma once

#include <array>

#include "viewer/gl/gl.hpp"
#include "viewer/light/light.hpp"
#include "viewer/looks/cloud_map.hpp"
#include "viewer/meshes/far_country.hpp"
#include "viewer/meshes/view.hpp"

namespace yuragi::viewer::looks {

/// The ground, the far country and the sky around the scenes. Drawn after them, so that what they cover is not painted.
/// Needs a current context.
class Landscape {
 public:
  Landscape();

  /// Before a picture in this light. Binds another framebuffer.
  void prepare(const light::Light& light) { clouds_.advance(light, noise_); }

  /// The same View (ViewBuffer::set) and the GroundMaps are bound. The ground has holes and shadows where the stencil
  /// has kHole and kShadow.
  void draw(const meshes::View& view);
  /// The hills and the sky alone.
  void draw_sky(const meshes::View& view);

 private:
  void draw_far_country(const meshes::View& view);

  gl::GlTexture noise_;
  CloudMap clouds_;
  gl::GlProgram ground_;
  GLint sunlight_place_ = -1;
  gl::GlProgram hills_;
  GLint range_place_ = -1;
  struct Range {
    gl::GlBuffer corners;
    gl::GlVertexArray array;
  };
  std::array<Range, meshes::kFarRanges.size()> ranges_;
  gl::GlProgram sky_;
  gl::GlVertexArray no_attributes_;
};

}  // namespace yuragi::viewer::looks
