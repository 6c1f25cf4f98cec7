#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "engine/look/cloth_look.hpp"
#include "engine/look/look.hpp"
#include "engine/pose/point_kinematics.hpp"
#include "viewer/looks/board_floor.hpp"
#include "viewer/looks/cloth_sheet.hpp"
#include "viewer/looks/scene_renderer.hpp"
#include "viewer/looks/solids.hpp"
#include "viewer/meshes/cloth_holder.hpp"

namespace yuragi::viewer::looks {

/// Draws a cloth and what holds it: a curtain of linen that light shines through, a flag, a nobori banner. It has as
/// many points as its size in the picture and the quality need, and its shadow fewer.
class ClothRenderer : public SceneRenderer {
 public:
  /// `cloth` must outlive this.
  ClothRenderer(const pose::GridSkeleton& cloth, std::string_view kind, const look::ClothLook& look,
                look::Quality quality)
      : ClothRenderer(cloth, meshes::cloth_style(kind, cloth), look, quality) {}

  void move_to(const pose::Pose& pose) override;
  void draw(const meshes::View& view) override;
  void draw_shadow(const meshes::View& view) override;
  bool casts_shadow() const override { return true; }
  meshes::Bounds bounds_with_holder(const meshes::Bounds& bounds) const override {
    return meshes::united(bounds, holder_bounds_);
  }
  std::optional<meshes::Floor> floor() const override { return floor_; }

 private:
  static constexpr int kLevels = meshes::ClothSurface::kFinest - meshes::ClothSurface::kCoarsest + 1;

  ClothRenderer(const pose::GridSkeleton& cloth, meshes::ClothStyle style, const look::ClothLook& look,
                look::Quality quality)
      : ClothRenderer(cloth, style, look, quality, meshes::cloth_holder(style, cloth)) {}
  ClothRenderer(const pose::GridSkeleton& cloth, meshes::ClothStyle style, const look::ClothLook& look,
                look::Quality quality, const meshes::SolidMesh& holder);

  /// Returns the level of detail whose cells are at most `cell_px` pixels of `view` wide; keeps that of `before` if it
  /// nearly is.
  int level_in(const meshes::View& view, float cell_px, const std::optional<int>& before) const;
  /// Distance from the view's eye to the cloth.
  float nearest_m(const meshes::View& view) const;
  /// The sheet of a level, of the present pose.
  ClothSheet& sheet(int level);

  const pose::GridSkeleton* cloth_;
  meshes::ClothMeasure lies_;
  meshes::ClothStyle style_;
  bool is_vane_;  ///< its holder turns with its fixed edge
  pose::PointPositions points_;
  float cell_px_;                                          ///< along a row
  int finer_down_;                                         ///< ClothSurface
  bool is_shadow_coarse_;                                  ///< with quality low cloth receives no shadows
  std::optional<int> level_, shadow_level_;                ///< of the last picture
  std::array<std::optional<ClothSheet>, kLevels> sheets_;  ///< made when first needed
  std::array<bool, kLevels> is_moved_{};
  meshes::Bounds holder_bounds_;
  Solids holder_;
  float wire_m_;  ///< thickness of the holder's rings
  std::optional<meshes::Floor> floor_;
  std::optional<BoardFloor> boards_;  ///< of the floor
  gl::Program program_;
  std::optional<gl::Texture> picture_;
};

}  // namespace yuragi::viewer::looks
