#pragma once

#include <array>
#include <vector>

#include "engine/look/look.hpp"
#include "viewer/gl/gl.hpp"
#include "viewer/gl/texel_buffer.hpp"
#include "viewer/meshes/ground_map.hpp"
#include "viewer/meshes/sward.hpp"

namespace yuragi::viewer::looks {

/// The amount of grass of a quality, streamed and other.
const meshes::GrassDetail& grass_detail(look::Quality quality);

/// Blades of grass around the eye as far as they can be distinguished, drawn from static buffers: tall grass around a
/// stand of streamed blades, as dense, or a lawn. The View and the GroundMaps are bound. Needs a current context.
class Sward {
 public:
  enum class Kind : std::uint8_t { kTall, kLawn };
  Sward(Kind kind, const meshes::Stand& stand, const meshes::GrassDetail& detail);

  /// From now on only this share (0 to 1] of the detail's blades is drawn.
  void set_blade_share(float share);
  void draw(const meshes::View& view, const meshes::GrowthMap& growth);

 private:
  Kind kind_;
  meshes::GrassDetail detail_;  ///< of this kind
  meshes::Thinning thinning_;
  std::size_t blades_per_tile_;
  meshes::SwardTiles tiles_;
  gl::Program program_;
  gl::VertexArray array_;
  GLint first_corner_place_ = -1;
  gl::TexelBuffer blades_{GL_RGBA32F}, tiles_on_gpu_{GL_RGBA32F};
  std::array<gl::Buffer, meshes::SwardTiles::kLevels> triangles_;
  std::vector<meshes::SwardTile> drawn_;  ///< tiles of all levels, one behind the other
};

}  // namespace yuragi::viewer::looks
