#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "engine/pose/tree_kinematics.hpp"
#include "viewer/gl/gl.hpp"
#include "viewer/looks/scene_renderer.hpp"
#include "viewer/meshes/bounds.hpp"
#include "viewer/meshes/branches.hpp"
#include "viewer/meshes/crown.hpp"

namespace yuragi::viewer::looks {

/// Draws a tree and its grove: tapering branches with bark, and sprays of leaves, flowers or bare twigs. Each is as
/// fine as the picture and the quality need.
class TreeRenderer : public SceneRenderer {
 public:
  /// `tree` must outlive this.
  TreeRenderer(const pose::TreeSkeleton& tree, look::Quality quality);

  void move_to(const pose::Pose& pose) override;
  void draw(const meshes::View& view) override;
  void draw_shadow(const meshes::View& view) override;
  /// Darkens the ground around the foot of a trunk.
  void draw_light() override;
  bool casts_shadow() const override { return true; }

 private:
  /// A level of wood.
  struct Wood {
    std::size_t level = 0;
    gl::GlBuffer part_buffer = {};
    std::array<gl::GlBuffer, meshes::Branches::kSides.size()> tubes = {};  // triangles, ring behind ring
    gl::GlVertexArray array = {};
  };

  /// A spray's mesh on the GPU.
  struct SprayOnGpu {
    gl::GlBuffer corner_buffer;
    gl::GlBuffer index_buffer;
    gl::GlVertexArray array;
    std::size_t stalk_indices = 0;
    std::size_t leaf_indices = 0;
  };

  /// A level of leaves.
  struct Foliage {
    std::size_t level = 0;
    meshes::SprayShape shape = {};
    gl::GlBuffer place_buffer = {};
    std::array<SprayOnGpu, 3> sprays = {};  // by SprayKind
  };

  /// The trees that are turned alike: those have the same joints, since the wind bends all toward the same side.
  struct Alike {
    float cosine = 1.0F;
    float sine = 0.0F;
    std::vector<meshes::TreePlace> places;
    pose::TreePose bends;  // turned back
    pose::TreeJoints joints;
    std::vector<meshes::Branches> branches;  // of woods_
    std::vector<meshes::Crown> crowns;       // of foliages_
    gl::GlBuffer joint_buffer = {};
    gl::GlTexture joint_texture = {};
  };

  void add_place(const meshes::TreePlace& place);
  void move(Alike& alike, const pose::TreePose& bends);
  static void make_spray(SprayOnGpu& spray, const meshes::SprayMesh& mesh);
  void draw_all(const meshes::View& view, const meshes::SprayDetail& detail, float ring_px);
  void draw_branches(const Wood& wood, const meshes::Branches& branches, const meshes::TreePlace& place);
  void draw_sprays(const Foliage& foliage, const meshes::Crown& crown);

  const pose::TreeSkeleton* tree_;
  meshes::Bounds crown_bounds_;  // of the leaves, or of all where there are none
  std::vector<std::unique_ptr<Wood>> woods_;
  std::vector<std::unique_ptr<Foliage>> foliages_;
  meshes::SprayDetail detail_;
  float ring_px_;
  gl::GlProgram bark_;
  gl::GlProgram leaf_;
  gl::GlProgram contact_;
  std::vector<std::unique_ptr<Alike>> trees_;  // the streamed one is the first of the first
};

}  // namespace yuragi::viewer::looks
