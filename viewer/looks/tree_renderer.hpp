#pragma once

#include <vector>

#include "engine/pose/tree_kinematics.hpp"
#include "viewer/gl/gl.hpp"
#include "viewer/looks/scene_renderer.hpp"
#include "viewer/meshes/bounds.hpp"
#include "viewer/meshes/sprays.hpp"
#include "viewer/meshes/tree_parts.hpp"

namespace yuragi::viewer::looks {

/// Draws a tree: tapering branches with bark, and sprays of leaves or flowers that the low sun shines through.
class TreeRenderer : public SceneRenderer {
 public:
  /// `tree` must outlive this.
  explicit TreeRenderer(const pose::TreeSkeleton& tree);

  void move_to(const pose::Pose& pose) override;
  void draw(const meshes::View& view) override;
  /// Darkens the ground around the foot of a trunk.
  void draw_light() override;
  bool casts_shadow() const override { return true; }

 private:
  /// A spray's mesh on the GPU.
  struct Spray {
    gl::GlBuffer corner_buffer;
    gl::GlBuffer index_buffer;
    gl::GlVertexArray array;
    std::size_t stalk_indices = 0;
    std::size_t leaf_indices = 0;
  };

  struct Level {
    gl::GlBuffer part_buffer;
    gl::GlBuffer index_buffer;  // of branches: the triangles of a tube, ring behind ring
    gl::GlVertexArray array;
    GLsizei sides = 0;
    Spray near_spray;  // of leaves
    Spray far_spray;
    float spray_length_m = 0.0F;
  };

  static void make_spray(Spray& spray, const meshes::SprayMesh& mesh, const gl::GlBuffer& part_buffer);
  void draw_branches(std::size_t level, std::size_t rings);
  void draw_sprays(std::size_t level, const meshes::View& view);

  const pose::TreeSkeleton* tree_;
  meshes::Bounds bounds_;
  pose::TreeJoints joints_;
  std::vector<Level> levels_;
  meshes::SprayShape spray_shape_;
  gl::GlProgram bark_;
  gl::GlProgram leaf_;
  gl::GlProgram contact_;
  gl::GlBuffer joint_buffer_;
  gl::GlTexture joint_texture_;
};

}  // namespace yuragi::viewer::looks
