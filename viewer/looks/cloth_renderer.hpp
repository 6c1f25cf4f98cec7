#pragma once

#include <string_view>

#include "engine/pose/point_kinematics.hpp"
#include "viewer/looks/grid_sheet.hpp"
#include "viewer/looks/scene_renderer.hpp"
#include "viewer/looks/solids.hpp"
#include "viewer/meshes/cloth_measure.hpp"

namespace yuragi::viewer::looks {

/// Draws a cloth and what holds it: a curtain of linen that light shines through, a flag, a nobori banner.
class ClothRenderer : public SceneRenderer {
 public:
  /// `cloth` must outlive this.
  ClothRenderer(const pose::GridSkeleton& cloth, std::string_view kind);

  void move_to(const pose::Pose& pose) override;
  void draw(const meshes::View& view) override;
  bool casts_shadow() const override { return true; }

 private:
  const pose::GridSkeleton* cloth_;
  bool is_vane_;  ///< what holds it turns with its fixed edge
  pose::PointPositions points_;
  GridSheet sheet_;
  Solids holder_;
  gl::GlProgram program_;
};

}  // namespace yuragi::viewer::looks
