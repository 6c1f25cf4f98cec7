#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "engine/look/cloth_look.hpp"
#include "engine/pose/point_kinematics.hpp"
#include "viewer/looks/board_floor.hpp"
#include "viewer/looks/cloth_sheet.hpp"
#include "viewer/looks/scene_renderer.hpp"
#include "viewer/looks/solids.hpp"
#include "viewer/meshes/cloth_holder.hpp"

namespace yuragi::viewer::looks {

/// Draws a cloth and what holds it: a curtain of linen that light shines through, a flag, a nobori banner. It has as
/// many points as its size in the picture needs.
class ClothRenderer : public SceneRenderer {
 public:
  /// `cloth` must outlive this.
  ClothRenderer(const pose::GridSkeleton& cloth, std::string_view kind, const look::ClothLook& look)
      : ClothRenderer(cloth, meshes::cloth_style(kind, cloth), look) {}

  void move_to(const pose::Pose& pose) override;
  void draw(const meshes::View& view) override;
  bool casts_shadow() const override { return true; }
  meshes::Bounds bounds_with_holder(const meshes::Bounds& bounds) const override {
    return meshes::united(bounds, holder_bounds_);
  }
  std::optional<meshes::Floor> floor() const override { return floor_; }

 private:
  ClothRenderer(const pose::GridSkeleton& cloth, meshes::ClothStyle style, const look::ClothLook& look)
      : ClothRenderer(cloth, style, look, meshes::cloth_holder(style, cloth)) {}
  ClothRenderer(const pose::GridSkeleton& cloth, meshes::ClothStyle style, const look::ClothLook& look,
                const meshes::SolidMesh& holder);

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
  meshes::Bounds holder_bounds_;
  Solids holder_;
  std::optional<meshes::Floor> floor_;
  std::optional<BoardFloor> boards_;  ///< of the floor
  gl::GlProgram program_;
  std::optional<gl::GlTexture> picture_;
};

}  // namespace yuragi::viewer::looks
