#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "engine/pose/point_kinematics.hpp"
#include "viewer/looks/cloth_sheet.hpp"
#include "viewer/looks/scene_renderer.hpp"
#include "viewer/looks/solids.hpp"
#include "viewer/meshes/cloth_measure.hpp"

namespace yuragi::viewer::looks {

/// Draws a cloth and what holds it: a curtain of linen that light shines through, a flag, a nobori banner. It has as
/// many points as its size in the picture needs.
class ClothRenderer : public SceneRenderer {
 public:
  /// `cloth` must outlive this.
  ClothRenderer(const pose::GridSkeleton& cloth, std::string_view kind);

  void move_to(const pose::Pose& pose) override;
  void draw(const meshes::View& view) override;
  bool casts_shadow() const override { return true; }

 private:
  /// The level of detail whose cells are a few pixels of `view` wide.
  int level_in(const meshes::View& view) const;
  float nearest_m(const meshes::View& view) const;
  /// The sheet of the present level, of the present pose.
  ClothSheet& sheet();

  const pose::GridSkeleton* cloth_;
  meshes::ClothMeasure lies_;
  meshes::ClothStyle style_;
  bool is_vane_;  ///< what holds it turns with its fixed edge
  pose::PointPositions points_;
  int level_ = 0;
  std::array<std::optional<ClothSheet>, meshes::ClothSurface::kFinest - meshes::ClothSurface::kCoarsest + 1>
      sheets_;  ///< made when first needed
  std::array<bool, meshes::ClothSurface::kFinest - meshes::ClothSurface::kCoarsest + 1> is_moved_{};
  Solids holder_;
  gl::GlProgram program_;
};

}  // namespace yuragi::viewer::looks
