#include "viewer/looks/cloth_look.hpp"
#include "viewer/looks/flame_look.hpp"
#include "viewer/looks/fur_look.hpp"
#include "viewer/looks/grass_look.hpp"
#include "viewer/looks/look.hpp"
#include "viewer/looks/tree_look.hpp"
#include "viewer/looks/water_look.hpp"

namespace yuragi {
namespace {

std::unique_ptr<Look> look_of(const StrandSkeleton& strands, const wire::SceneModel& scene) {
  if (scene.kind == "fur") return std::make_unique<FurLook>(strands);
  return std::make_unique<GrassLook>(strands);
}
std::unique_ptr<Look> look_of(const GridSkeleton& cloth, const wire::SceneModel& scene) {
  return std::make_unique<ClothLook>(cloth, scene.kind);
}
std::unique_ptr<Look> look_of(const TreeSkeleton& tree, const wire::SceneModel&) {
  return std::make_unique<TreeLook>(tree);
}
std::unique_ptr<Look> look_of(const SurfaceSkeleton& surface, const wire::SceneModel&) {
  if (surface.ramp_rgba.empty()) return std::make_unique<WaterLook>(surface);
  return std::make_unique<FlameLook>(surface);
}

}  // namespace

std::unique_ptr<Look> make_look(const wire::SceneModel& scene) {
  return std::visit([&](const auto& kind) { return look_of(kind, scene); }, scene.skeleton);
}

}  // namespace yuragi
