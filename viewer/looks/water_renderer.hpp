#pragma once

#include "engine/pose/point_kinematics.hpp"
#include "viewer/looks/grid_sheet.hpp"
#include "viewer/looks/scene_renderer.hpp"
#include "viewer/looks/solids.hpp"

namespace yuragi {

/// Draws a surface as water in a stone basin, with the evening sky in it.
class WaterRenderer : public SceneRenderer {
 public:
  /// `surface` must outlive this.
  explicit WaterRenderer(const SurfaceSkeleton& surface);

  void move_to(const Pose& pose) override;
  void draw(const View& view) override;
  void draw_hole() override;

 private:
  const SurfaceSkeleton* surface_;
  PointPositions points_;
  GridSheet sheet_;
  Solids basin_;
  Solids hole_;
  GlProgram program_;
};

/// A rim of stone around the surface's four corners, from below the ground; and the ground that it takes away. Pure.
SolidMesh water_basin(const SurfaceSkeleton& surface);
SolidMesh water_hole(const SurfaceSkeleton& surface);

}  // namespace yuragi
