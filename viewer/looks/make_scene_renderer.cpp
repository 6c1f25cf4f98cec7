#include "viewer/looks/cloth_renderer.hpp"
#include "viewer/looks/flame_renderer.hpp"
#include "viewer/looks/fur_renderer.hpp"
#include "viewer/looks/grass_renderer.hpp"
#include "viewer/looks/scene_renderer.hpp"
#include "viewer/looks/tree_renderer.hpp"
#include "viewer/looks/water_renderer.hpp"

namespace yuragi::viewer::looks {
namespace {

std::unique_ptr<SceneRenderer> renderer_of(const pose::StrandSkeleton& strands, const wire::SceneModel& scene) {
  if (scene.kind == "fur") return std::make_unique<FurRenderer>(strands);
  return std::make_unique<GrassRenderer>(strands);
}
std::unique_ptr<SceneRenderer> renderer_of(const pose::GridSkeleton& cloth, const wire::SceneModel& scene) {
  return std::make_unique<ClothRenderer>(cloth, scene.kind);
}
std::unique_ptr<SceneRenderer> renderer_of(const pose::TreeSkeleton& tree, const wire::SceneModel&) {
  return std::make_unique<TreeRenderer>(tree);
}
std::unique_ptr<SceneRenderer> renderer_of(const pose::SurfaceSkeleton& surface, const wire::SceneModel&) {
  if (surface.ramp_rgba.empty()) return std::make_unique<WaterRenderer>(surface);
  return std::make_unique<FlameRenderer>(surface);
}

}  // namespace

std::unique_ptr<SceneRenderer> make_scene_renderer(const wire::SceneModel& scene) {
  return std::visit([&](const auto& kind) { return renderer_of(kind, scene); }, scene.skeleton);
}

}  // namespace yuragi::viewer::looks
