#pragma once

#include <glm/vec3.hpp>

#include "engine/pose/point_kinematics.hpp"
#include "viewer/looks/grid_sheet.hpp"
#include "viewer/looks/scene_renderer.hpp"
#include "viewer/looks/solids.hpp"

namespace yuragi::viewer::looks {

/// Draws a surface that burns: each point's heat through the skeleton's ramp, blended over everything else, in a glow,
/// over an iron bowl.
class FlameRenderer : public SceneRenderer {
 public:
  /// `surface` must outlive this.
  explicit FlameRenderer(const pose::SurfaceSkeleton& surface);

  void move_to(const pose::Pose& pose) override;
  void draw(const meshes::View& view) override;
  void draw_light() override;

 private:
  const pose::SurfaceSkeleton* surface_;
  pose::PointPositions points_;
  GridSheet sheet_;
  Solids bowl_;
  gl::GlTexture ramp_;
  gl::GlProgram program_;
  gl::GlProgram glow_program_;
  GLint glow_ball_place_ = -1;
  GLint glow_strength_place_ = -1;
  gl::GlVertexArray no_attributes_;
  glm::vec3 glow_middle_m_{0.0F};
  float glow_radius_m_ = 1.0F;
  float strength_ = 0.0F;  // of the glow: the mean heat
};

/// A bowl of embers under the flame's foot. Pure.
meshes::SolidMesh flame_bowl(const pose::SurfaceSkeleton& surface);

}  // namespace yuragi::viewer::looks
