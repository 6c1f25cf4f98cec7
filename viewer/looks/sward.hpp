#pragma once

#include <array>
#include <vector>

#include "engine/look/look.hpp"
#include "viewer/gl/gl.hpp"
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
  gl::Buffer blade_buffer_, tile_buffer_;
  gl::Texture blade_texture_, tile_texture_;
  std::array<gl::Buffer, meshes::SwardTiles::kLevels> triangles_;
  std::vector<GLsizei> counts_;
  std::vector<const void*> offsets_;
  std::vector<GLint> first_corners_;
};

}  // namespace yuragi::viewer::looks
