#pragma once

#include <utility>

#include "viewer/picture/renderer.hpp"

namespace yuragi::viewer::picture {

/// Draws nothing: everything but OpenGL, for tests and for machines without it. Its pictures are black.
class NullRenderer final : public Renderer {
 public:
  NullRenderer(int width_px, int height_px)
      : aspect_(static_cast<double>(width_px) / height_px),
        rgb_(std::size_t{3} * static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px)) {}

  void set_scenes(std::vector<wire::SceneModel> models) override;
  const std::vector<const wire::SceneModel*>& scenes() const override { return scenes_; }
  void show_only(const std::string& /*scene*/) override {}
  double aspect() const override { return aspect_; }
  meshes::CameraPlace home(double /*wind_from_deg*/) const override { return {}; }
  meshes::CameraPlace outside(const meshes::CameraPlace& place) const override { return place; }
  std::optional<meshes::Bounds> bounds_of(std::string_view scene) const override;
  void set_light(const light::Light& /*light*/) override {}
  void set_quality(look::Quality /*quality*/, float /*density*/) override {}
  void draw(const Picture& /*picture*/) override {}
  std::vector<std::uint8_t> read_rgb() override { return rgb_; }

 private:
  const double aspect_;
  std::vector<wire::SceneModel> models_;
  std::vector<const wire::SceneModel*> scenes_;  // of models_
  std::vector<std::uint8_t> rgb_;
};

}  // namespace yuragi::viewer::picture
