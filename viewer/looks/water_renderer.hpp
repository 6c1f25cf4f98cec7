#pragma once

#include <array>

#include "engine/pose/point_kinematics.hpp"
#include "viewer/gl/gl.hpp"
#include "viewer/gl/strip_indices.hpp"
#include "viewer/gl/texel_buffer.hpp"
#include "viewer/looks/scene_renderer.hpp"
#include "viewer/looks/water_memory.hpp"
#include "viewer/meshes/shore.hpp"

namespace yuragi::viewer::looks {

/// Draws a surface as a pond with a natural shore, which mirrors sky and things.
class WaterRenderer : public SceneRenderer {
 public:
  /// `surface` must outlive this. With quality low nothing casts a shadow on it.
  WaterRenderer(const pose::SurfaceSkeleton& surface, look::Quality quality);

  void set_moment(const Moment& moment) override;
  void move_to(const pose::Pose& pose) override;
  void feel_ground(const GroundMaps& ground) override;
  void draw(const meshes::View& view) override;
  void draw_hole() override;
  std::optional<float> mirror_m() const override;
  void set_mirror_share(float share) override { mirror_share_ = share; }
  /// The reeds.
  void draw_mirrored(const meshes::View& view) override;

 private:
  /// The water's surface at one level of detail: triangles of its points.
  struct Sheet {
    gl::Buffer indices = {};
    gl::VertexArray array = {};
    GLsizei index_count = 0;
  };
  static constexpr std::array<std::size_t, 4> kSteps = {1, 2, 4, 8};  // steps of points along each side

  void make_sheet();
  void make_memory();
  void draw_bed();
  void sum_up_breaking();
  const Sheet& sheet_in(const meshes::View& view);
  void make_shore();
  void draw_reeds(GLint rings);

  const pose::SurfaceSkeleton* surface_;
  meshes::Shore shore_;
  pose::PointPositions points_;
  meshes::WaveSlopes waves_;
  float mirror_share_ = 0.0F;
  GLsizei hole_count_ = 0, bank_count_ = 0;
  std::size_t reed_count_ = 0;
  gl::Program water_, bed_, bank_, hole_, reed_;
  GLint reed_rings_place_, reed_first_corner_place_, mirror_share_place_;
  gl::Texture slopes_, ripples_;
  gl::TexelBuffer reeds_{GL_RGBA32F};
  gl::VertexArray hole_array_, bank_array_;
  std::array<Sheet, kSteps.size()> sheets_;
  std::size_t level_ = 0;  // index into sheets_, of the last picture
  float cell_m_ = 0.0F;
  gl::Buffer rest_buffer_, height_buffer_;
  gl::Buffer bank_buffer_, hole_indices_, bank_indices_;
  gl::StripIndices reed_strips_;
  GLint lee_place_ = -1, streaks_place_ = -1;
  Moment moment_;
  WaterMemory memory_;
  std::vector<glm::vec2> memory_m_;      // the middles of its cells
  std::vector<std::size_t> cell_of_;     // index into memory_ for each point of the surface
  std::vector<float> gusts_, breaking_;  // of its cells
  std::vector<float> points_per_cell_;
  gl::Texture memory_texture_, bed_texture_;
  GLsizei bed_texels_;
  float cell_px_;
  bool has_bed_ = false;
};

}  // namespace yuragi::viewer::looks
