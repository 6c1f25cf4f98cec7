#pragma once

#include "engine/pose/point_kinematics.hpp"
#include "viewer/looks/grid_sheet.hpp"
#include "viewer/looks/scene_renderer.hpp"
#include "viewer/looks/solids.hpp"

namespace yuragi::viewer::looks {

/// Draws a surface as water in a stone basin, with the evening sky in it.
class WaterRenderer : public SceneRenderer {
 public:
  /// `surface` must outlive this.
  explicit WaterRenderer(const pose::SurfaceSkeleton& surface);

  void move_to(const pose::Pose& pose) override;
  void draw(const meshes::View& view) override;
  void draw_hole() override;

 private:
  const pose::SurfaceSkeleton* surface_;
  pose::PointPositions points_;
  GridSheet sheet_;
  Solids basin_;
  Solids hole_;
  gl::GlProgram program_;
};

/// A rim of stone around the surface's four corners, from below the ground; and the ground that it takes away. Pure.
meshes::SolidMesh water_basin(const pose::SurfaceSkeleton& surface);
meshes::SolidMesh water_hole(const pose::SurfaceSkeleton& surface);

}  // namespace yuragi::viewer::looks
