#pragma once

#include <optional>
#include <vector>

#include "engine/look/look.hpp"
#include "engine/pose/point_kinematics.hpp"
#include "viewer/looks/grid_sheet.hpp"
#include "viewer/looks/scene_renderer.hpp"
#include "viewer/looks/solids.hpp"
#include "viewer/meshes/flame_bowl.hpp"
#include "viewer/meshes/flame_gas.hpp"
#include "viewer/meshes/flame_volume.hpp"
#include "viewer/meshes/sparks.hpp"

namespace yuragi::viewer::looks {

/// Draws a surface that burns, over a bowl: a closed one as burning gas (FlameGas) with sparks, a flat one as a
/// sheet. Its colours are those of the skeleton's ramp. Its light is added to the background nearly as by the tone
/// curve (1 - (1 - a) (1 - b)), so that it is pale by day and glows by night.
class FlameRenderer : public SceneRenderer {
 public:
  /// `surface` must outlive this.
  FlameRenderer(const pose::SurfaceSkeleton& surface, look::Quality quality);

  void set_moment(const Moment& moment) override { moment_ = moment; }
  void move_to(const pose::Pose& pose) override;
  void draw(const meshes::View& view) override;
  void draw_light() override;
  bool throws_light() const override { return true; }
  std::optional<light::Fire> fire() const override;
  meshes::Bounds bounds_with_holder(const meshes::Bounds& bounds) const override;
  bool casts_shadow() const override { return true; }

 private:
  void move_sheet(const pose::SurfacePose& burning);
  void draw_contact();
  void draw_bowl_shade();
  void draw_glow();
  void draw_embers();
  void draw_body();
  void draw_sparks();

  const pose::SurfaceSkeleton* surface_;
  Moment moment_;
  meshes::FlameBowl bowl_;
  Solids bowl_solids_;
  gl::Texture ramp_, noise_;
  gl::VertexArray no_attributes_;
  float height_m_ = 1.0F, width_m_ = 1.0F;

  // The middle of the heat, its amount, and the share of it that the light shows.
  glm::vec3 hot_middle_m_{0.0F};
  float heat_ = 0.0F;
  float shown_heat_ = 0.0F;
  light::FireFlicker flicker_;

  // A body of gas.
  meshes::FlameVolume volume_;
  std::optional<meshes::FlameGas> gas_;
  meshes::Sparks sparks_;
  std::vector<float> streamed_heat_;
  double moved_at_s_ = -1e9;
  int steps_;
  gl::Program fire_program_, spark_program_;
  gl::Texture gas_tile_, layer_rows_;
  gl::Buffer hull_buffer_, hull_indices_, spark_buffer_;
  gl::VertexArray hull_array_, spark_array_;
  GLint risen_place_ = -1, fire_brightness_place_ = -1, fire_by_day_place_ = -1, spark_brightness_place_ = -1;

  // A sheet.
  std::optional<pose::PointPositions> points_;
  std::optional<GridSheet> sheet_;
  gl::Program sheet_program_;
  GLint sheet_brightness_place_ = -1;

  gl::Program glow_program_, embers_program_, contact_program_, shade_program_;
  GLint glow_ball_place_ = -1, glow_light_place_ = -1;
  GLint shade_place_ = -1;
  GLint embers_brightness_place_ = -1, embers_breath_place_ = -1;
};

}  // namespace yuragi::viewer::looks
