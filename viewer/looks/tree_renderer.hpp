#pragma once

#include <vector>

#include "engine/pose/tree_kinematics.hpp"
#include "viewer/gl/gl.hpp"
#include "viewer/looks/scene_renderer.hpp"
#include "viewer/meshes/bounds.hpp"
#include "viewer/meshes/tree_parts.hpp"

namespace yuragi {

/// Draws a tree: tapering branches with bark, and leaves that the low sun shines through.
class TreeRenderer : public SceneRenderer {
 public:
  /// `tree` must outlive this.
  explicit TreeRenderer(const TreeSkeleton& tree);

  void move_to(const Pose& pose) override;
  void draw(const View& view) override;
  bool casts_shadow() const override { return true; }

 private:
  struct Level {
    GlBuffer part_buffer;
    GlBuffer index_buffer;  // of branches: the triangles of a tube, ring behind ring
    GlVertexArray array;
    GLsizei sides = 0;
  };

  void draw_branches(std::size_t level, std::size_t rings);
  void draw_leaves(std::size_t level);

  const TreeSkeleton* tree_;
  Bounds bounds_;
  TreeJoints joints_;
  std::vector<Level> levels_;
  GlProgram bark_;
  GlProgram leaf_;
  GlBuffer joint_buffer_;
  GlTexture joint_texture_;
};

}  // namespace yuragi
