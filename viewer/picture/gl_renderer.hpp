#pragma once

#include <memory>
#include <optional>

#include "viewer/gl/cross_fade.hpp"
#include "viewer/gl/edge_smoother.hpp"
#include "viewer/gl/render_target.hpp"
#include "viewer/looks/stage.hpp"
#include "viewer/pace/pace_ladder.hpp"
#include "viewer/picture/renderer.hpp"

namespace yuragi::viewer::picture {

/// Draws by OpenGL into its target: all of each picture, or less if asked to.
class GlRenderer final : public Renderer {
 public:
  /// Needs a current context. Keeps `context` for as long as it is needed; null: a window's or a page's, which outlives
  /// it.
  GlRenderer(std::shared_ptr<void> context, int width_px, int height_px, int samples);

  /// The size of the pictures from the next one on.
  void resize(int width_px, int height_px);
  /// How much of the next pictures is drawn; all at first.
  void set_drawn(const pace::DrawnPart& drawn) { drawn_ = drawn; }
  /// Sets the quality for looks that leave it to the viewer; initially high.
  void set_own_quality(look::Quality quality) { own_quality_ = quality; }
  /// The quality that was last set: kAuto if the viewer chooses.
  look::Quality wanted_quality() const { return wanted_quality_; }
  look::Quality quality() const { return quality_; }
  /// Sets the frustum of every camera, regardless of its field of view.
  void see_through(const meshes::Frustum& frustum) { camera_.see_through(frustum); }

  looks::Stage& stage() { return stage_; }
  gl::RenderTarget& target() { return target_; }

  void set_scenes(std::vector<wire::SceneModel> scenes) override { stage_.set_scenes(std::move(scenes)); }
  const std::vector<const wire::SceneModel*>& scenes() const override { return stage_.scenes(); }
  void show_only(const std::string& scene) override { stage_.show_only(scene); }
  double aspect() const override { return static_cast<double>(target_.width_px()) / target_.height_px(); }
  meshes::CameraPlace home(double wind_from_deg) const override { return stage_.home(aspect(), wind_from_deg); }
  meshes::CameraPlace outside(const meshes::CameraPlace& place) const override { return stage_.outside(place); }
  std::optional<meshes::Bounds> bounds_of(std::string_view scene) const override { return stage_.bounds_of(scene); }
  std::vector<meshes::Bounds> obstacles() const override { return stage_.obstacles(); }
  void set_light(const light::Light& light) override { stage_.set_light(light); }
  void set_quality(look::Quality quality, float density) override;
  void draw(const Picture& picture) override;
  std::vector<std::uint8_t> read_rgb() override { return target_.read_rgb(); }

 private:
  const std::shared_ptr<void> context_;  // the members below need it, or a window's
  const int samples_;
  looks::Stage stage_;
  gl::CrossFade cross_fade_;
  gl::EdgeSmoother edge_smoother_;  // with quality low
  gl::RenderTarget target_;
  meshes::OrbitCamera camera_;
  pace::DrawnPart drawn_;
  look::Quality own_quality_ = look::Quality::kHigh;
  look::Quality wanted_quality_ = look::Quality::kAuto;
  look::Quality quality_ = look::Quality::kAuto;
  float density_ = 1.0F;
};

}  // namespace yuragi::viewer::picture
