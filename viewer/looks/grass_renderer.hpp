#pragma once

#include <vector>

#include "engine/pose/strand_kinematics.hpp"
#include "viewer/gl/gl.hpp"
#include "viewer/looks/scene_renderer.hpp"
#include "viewer/meshes/ground_map.hpp"
#include "viewer/meshes/strand_tiles.hpp"

namespace yuragi::viewer::looks {

/// Draws streamed strands as blades of a meadow, from static buffers, tile by tile: what is not in view, and blades
/// that are left out far away, are not moved, either. The GroundMaps are bound.
class GrassRenderer : public SceneRenderer {
 public:
  /// `strands` must outlive this.
  GrassRenderer(const pose::StrandSkeleton& strands, float drawn_at_1m_per_m2);

  void move_to(const pose::Pose& pose) override;
  void draw(const meshes::View& view) override;
  bool is_field() const override { return true; }

 private:
  void upload_joints();

  meshes::Thinning thinning_;
  meshes::StrandTiles tiles_;
  const pose::StrandPose* latest_ = nullptr;  ///< of the picture being drawn
  pose::StrandPose pose_;                     ///< of the tiles' skeleton, where it is in view
  pose::JointPositions joints_;
  std::vector<float> shown_joints_;  ///< of the blocks that are drawn, one behind the other
  gl::GlProgram program_;
  gl::GlVertexArray array_;
  gl::GlBuffer blade_buffer_, joint_buffer_, block_buffer_;
  gl::GlTexture blade_texture_, joint_texture_, block_texture_;
  std::vector<gl::GlBuffer> triangles_;  ///< of each level of detail
  std::vector<GLsizei> counts_;
  std::vector<const void*> offsets_;
  std::vector<GLint> first_corners_;
};

}  // namespace yuragi::viewer::looks
