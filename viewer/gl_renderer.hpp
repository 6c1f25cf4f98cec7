#pragma once

#include <memory>

#include "viewer/gl/cross_fade.hpp"
#include "viewer/gl/headless_context.hpp"
#include "viewer/gl/render_target.hpp"
#include "viewer/looks/stage.hpp"
#include "viewer/renderer.hpp"

namespace yuragi::viewer {

/// A current context that needs no display. Throws ViewerExit (EX_UNAVAILABLE) where there is none to be had.
std::unique_ptr<gl::HeadlessContext> make_headless_context();

/// Draws by OpenGL, all of each picture, without a window or a display.
class GlRenderer final : public Renderer {
 public:
  /// Throws ViewerExit (EX_UNAVAILABLE) where no driver can do it.
  GlRenderer(int width_px, int height_px, int samples);

  void set_scenes(std::vector<wire::SceneModel> scenes) override { stage_.set_scenes(std::move(scenes)); }
  const std::vector<const wire::SceneModel*>& scenes() const override { return stage_.scenes(); }
  void show_only(const std::string& scene) override { stage_.show_only(scene); }
  meshes::CameraPlace home(double aspect) const override { return stage_.home(aspect); }
  std::optional<meshes::Bounds> bounds_of(std::string_view scene) const override { return stage_.bounds_of(scene); }
  void set_light(const light::Light& light) override { stage_.set_light(light); }
  void set_quality(look::Quality quality, float density) override;
  void draw(const Picture& picture) override;
  std::vector<std::uint8_t> read_rgb() override { return target_.read_rgb(); }

 private:
  const std::unique_ptr<gl::HeadlessContext> context_;  // the members below need it
  looks::Stage stage_;
  gl::CrossFade cross_fade_;
  gl::RenderTarget target_;
  meshes::OrbitCamera camera_;
};

}  // namespace yuragi::viewer
