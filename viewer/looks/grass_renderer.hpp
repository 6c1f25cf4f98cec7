#pragma once

#include <vector>

#include "viewer/gl/gl.hpp"
#include "viewer/gl/texel_buffer.hpp"
#include "viewer/looks/scene_renderer.hpp"
#include "viewer/meshes/ground_map.hpp"
#include "viewer/meshes/strand_tiles.hpp"

namespace yuragi::viewer::looks {

/// Draws streamed strands as blades of a meadow, from static buffers, tile by tile. For each picture only the bends of
/// the visible tiles are uploaded to the GPU, which makes arcs of them. The GroundMaps are bound.
class GrassRenderer : public SceneRenderer {
 public:
  /// `strands` must outlive this.
  GrassRenderer(const pose::StrandSkeleton& strands, const meshes::GrassDetail& detail);

  void move_to(const pose::Pose& pose) override;
  void draw(const meshes::View& view) override;
  void set_blade_share(float share) override;
  bool is_field() const override { return true; }

 private:
  meshes::GrassDetail detail_;
  meshes::Thinning thinning_;
  meshes::StrandTiles tiles_;
  const pose::StrandPose* latest_ = nullptr;  ///< of the picture being drawn
  gl::Program program_;
  gl::VertexArray array_;
  GLint first_corner_place_ = -1;
  gl::TexelBuffer blades_{GL_RGBA32F}, bends_{GL_RG32F}, blocks_{GL_R32UI};
  std::vector<gl::Buffer> triangles_;  ///< of each level of detail
};

}  // namespace yuragi::viewer::looks
