#pragma once

#include <glm/vec3.hpp>

#include "engine/pose/point_kinematics.hpp"
#include "viewer/looks/grid_sheet.hpp"
#include "viewer/looks/scene_renderer.hpp"
#include "viewer/looks/solids.hpp"

namespace yuragi {

/// Draws a surface that burns: each point's heat through the skeleton's ramp, blended over everything else, in a glow,
/// over an iron bowl.
class FlameRenderer : public SceneRenderer {
 public:
  /// `surface` must outlive this.
  explicit FlameRenderer(const SurfaceSkeleton& surface);

  void move_to(const Pose& pose) override;
  void draw(const View& view) override;
  void draw_light() override;

 private:
  const SurfaceSkeleton* surface_;
  PointPositions points_;
  GridSheet sheet_;
  Solids bowl_;
  GlTexture ramp_;
  GlProgram program_;
  GlProgram glow_program_;
  GLint glow_ball_place_ = -1;
  GLint glow_strength_place_ = -1;
  GlVertexArray no_attributes_;
  glm::vec3 glow_middle_m_{0.0F};
  float glow_radius_m_ = 1.0F;
  float strength_ = 0.0F;  // of the glow: the mean heat
};

/// A bowl of embers under the flame's foot. Pure.
SolidMesh flame_bowl(const SurfaceSkeleton& surface);

}  // namespace yuragi
