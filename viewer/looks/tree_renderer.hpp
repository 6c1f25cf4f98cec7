#pragma once

#include <array>
#include <memory>
#include <vector>

#include "engine/pose/tree_kinematics.hpp"
#include "viewer/gl/gl.hpp"
#include "viewer/gl/texel_buffer.hpp"
#include "viewer/looks/scene_renderer.hpp"
#include "viewer/looks/tree_impostors.hpp"
#include "viewer/meshes/bounds.hpp"
#include "viewer/meshes/sway_history.hpp"
#include "viewer/meshes/trees/branches.hpp"
#include "viewer/meshes/trees/crown.hpp"

namespace yuragi::viewer::looks {

/// Draws a tree and its grove: tapering branches with bark, and sprays of leaves, flowers or bare twigs. Their detail
/// depends on the picture and the quality.
class TreeRenderer : public SceneRenderer {
 public:
  /// `tree` must outlive this.
  TreeRenderer(const pose::TreeSkeleton& tree, look::Quality quality);

  void set_moment(const Moment& moment) override { moment_ = moment; }
  void move_to(const pose::Pose& pose) override;
  /// Makes the pictures of far trees, once.
  void prepare(const meshes::View& view, gl::ViewBuffer& views) override;
  void draw(const meshes::View& view) override;
  void draw_shadow(const meshes::View& view) override;
  /// Darkens the ground around the foot of a trunk.
  void draw_light() override;
  bool casts_shadow() const override { return true; }

 private:
  /// The programs that draw a tree: directly, or for its impostors' pictures.
  struct Programs {
    const gl::Program& bark;
    const gl::Program& leaf;
    LeafColors colors;
    float thinnest_px = 0.11F;  // minimum half width of twigs
  };

  /// A level of wood.
  struct Wood {
    std::size_t level = 0;
    float bare = 1.0F;  // meshes::trees::bare_share()
    gl::Buffer part_buffer = {};
    std::array<gl::Buffer, meshes::trees::Branches::kSides.size()> tubes = {};  // triangles, ring behind ring
    gl::VertexArray array = {};
  };

  /// A spray's mesh on the GPU.
  struct SprayOnGpu {
    gl::Buffer corner_buffer;
    gl::Buffer index_buffer;
    gl::VertexArray array;
    std::size_t stalk_indices = 0;
    std::size_t leaf_indices = 0;
  };

  /// A level of leaves; or, of a tree that loses them, the twigs that are seen then.
  struct Foliage {
    std::size_t level = 0;
    pose::FoliageColor color = pose::FoliageColor::kGreen;
    meshes::trees::SprayShape shape = {};
    gl::Buffer place_buffer = {};
    std::array<SprayOnGpu, 3> sprays = {};  // by SprayKind
  };

  /// Trees that are turned by the same angle: they have the same joints, because the wind bends all to the same side.
  struct Alike {
    float cosine = 1.0F;
    float sine = 0.0F;
    std::vector<meshes::trees::Place> places;
    pose::TreePose bends;   // turned back
    bool is_moved = false;  // the members below are up to date
    pose::TreeJoints joints;
    std::vector<meshes::trees::Branches> branches;  // of woods_
    std::vector<meshes::trees::Crown> crowns;       // of foliages_
    gl::TexelBuffer joints_on_gpu{GL_R32F};         // of the wood, level behind level
  };

  void add_place(const meshes::trees::Place& place);
  std::unique_ptr<Alike> tree_at(const meshes::trees::Place& place) const;
  static void turn_back(Alike& alike, const pose::TreePose& bends);
  void move(Alike& alike, float hanging_leaves);
  float impostor_share(const meshes::View& view, const meshes::trees::Place& place) const;
  glm::vec3 middle_m(const Alike& alike) const;
  static void make_spray(SprayOnGpu& spray, const meshes::trees::SprayMesh& mesh);
  void draw_all(const meshes::View& view, const meshes::trees::SprayDetail& detail, float ring_px, bool is_shadow);
  void draw_tree(const Programs& programs, const meshes::View& view, const meshes::trees::SprayDetail& detail,
                 float ring_px, Alike& alike, const meshes::trees::Place& place, float hanging);
  void draw_branches(const gl::Program& program, const Wood& wood, const meshes::trees::Branches& branches,
                     const meshes::trees::Place& place);
  void add_foliage(std::size_t level, pose::FoliageColor color);
  float shown_share(const Foliage& foliage, float hanging) const;
  static void draw_sprays(const gl::Program& program, const Foliage& foliage, const meshes::trees::Crown& crown);
  std::unique_ptr<TreeImpostors> pictures_of(gl::ViewBuffer& views, float hanging);

  const pose::TreeSkeleton* tree_;
  meshes::Bounds crown_bounds_;  // of the leaves, or of all if there are none
  std::vector<std::unique_ptr<Wood>> woods_;
  std::vector<std::unique_ptr<Foliage>> foliages_;
  meshes::trees::SprayDetail detail_;
  float ring_px_;
  float impostor_px_;
  LeafColors colors_;
  gl::Program bark_;
  gl::Program leaf_;
  gl::Program bark_shade_;  // for the map of shadows
  gl::Program leaf_shade_;
  gl::Program contact_;
  std::vector<std::unique_ptr<Alike>> trees_;  // the streamed one is the first of the first
  Moment moment_;
  meshes::trees::ImpostorBox box_;
  glm::vec3 middle_at_rest_m_{0.0F};  // of the tips of the thinnest wood
  meshes::SwayHistory sway_;
  std::unique_ptr<TreeImpostors> impostors_;        // made when first needed
  std::unique_ptr<TreeImpostors> bare_impostors_;   // of a tree that has lost its leaves
  std::vector<meshes::trees::Impostor> far_trees_;  // of a picture
};

}  // namespace yuragi::viewer::looks
