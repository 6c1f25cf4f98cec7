#pragma once

#include "engine/pose/point_kinematics.hpp"
#include "viewer/gl/gl.hpp"
#include "viewer/looks/scene_renderer.hpp"
#include "viewer/meshes/shore.hpp"

namespace yuragi::viewer::looks {

/// Draws a surface as a pond with a natural shore, in which sky and things are mirrored.
class WaterRenderer : public SceneRenderer {
 public:
  /// `surface` must outlive this.
  explicit WaterRenderer(const pose::SurfaceSkeleton& surface);

  void set_moment(const Moment& moment) override;
  void move_to(const pose::Pose& pose) override;
  void draw(const meshes::View& view) override;
  void draw_hole() override;
  std::optional<float> mirror_m() const override;
  /// The reeds.
  void draw_mirrored(const meshes::View& view) override;

 private:
  void make_sheet();
  void make_shore();
  void draw_reeds() const;

  const pose::SurfaceSkeleton* surface_;
  meshes::Shore shore_;
  pose::PointPositions points_;
  meshes::WaveSlopes waves_;
  GLsizei sheet_count_ = 0, hole_count_ = 0, bank_count_ = 0, reed_count_ = 0;
  gl::GlProgram water_, bank_, hole_, reed_;
  gl::GlTexture slopes_, ripples_;
  gl::GlVertexArray sheet_array_, hole_array_, bank_array_, reed_array_;
  gl::GlBuffer sheet_indices_, rest_buffer_, height_buffer_;
  gl::GlBuffer bank_buffer_, hole_indices_, bank_indices_, reed_buffer_;
  GLint lee_place_ = -1;
};

}  // namespace yuragi::viewer::looks
