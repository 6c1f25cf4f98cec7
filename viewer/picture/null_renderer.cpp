#include "viewer/picture/null_renderer.hpp"

namespace yuragi::viewer::picture {

void NullRenderer::set_scenes(std::vector<wire::SceneModel> models) {
  models_ = std::move(models);
  scenes_.clear();
  for (const wire::SceneModel& model : models_) scenes_.push_back(&model);
}

std::optional<meshes::Bounds> NullRenderer::bounds_of(std::string_view scene) const {
  for (const wire::SceneModel& model : models_) {
    if (model.name == scene) return meshes::bounds_of(model.skeleton);
  }
  return std::nullopt;
}

}  // namespace yuragi::viewer::picture
