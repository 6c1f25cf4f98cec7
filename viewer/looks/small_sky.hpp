#pragma once

#include <glm/vec2.hpp>

#include "viewer/gl/gl.hpp"
#include "viewer/light/light.hpp"
#include "viewer/looks/cloud_map.hpp"
#include "viewer/meshes/view.hpp"

namespace yuragi::viewer::looks {

/// The sky of a picture with a ninth of its pixels, which are then enlarged: if the processor draws, a full sky costs
/// as much as all grass. Its clouds are no sharper anyway (CloudMap); sun, moon and stars are drawn in full. Needs a
/// current context. Throws std::runtime_error if the driver cannot make it.
class SmallSky {
 public:
  SmallSky();

  /// Draws the part of it that can be above the ground in a picture of this size, whose View is bound. Binds another
  /// framebuffer. `noise`: the tile of viewer/gl/noise_texture.hpp.
  void make(const meshes::View& view, const CloudMap& clouds, const gl::Texture& noise, int width_px, int height_px);

  /// Draws it behind everything in the picture that it was made for. Unit 0 must have the same noise.
  void draw(const light::Light& light, const meshes::View& view);

 private:
  gl::Program small_, wide_, wide_heavens_;
  gl::VertexArray no_attributes_;
  gl::Texture texture_;
  gl::Framebuffer framebuffer_;
  glm::ivec2 size_px_{0}, picture_px_{0};
};

}  // namespace yuragi::viewer::looks
