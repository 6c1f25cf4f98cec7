#include "viewer/looks/cloth_renderer.hpp"
#include "viewer/looks/flame_renderer.hpp"
#include "viewer/looks/fur_renderer.hpp"
#include "viewer/looks/grass_renderer.hpp"
#include "viewer/looks/scene_renderer.hpp"
#include "viewer/looks/sward.hpp"
#include "viewer/looks/tree_renderer.hpp"
#include "viewer/looks/water_renderer.hpp"
#include "viewer/meshes/ground_map.hpp"

namespace yuragi::viewer::looks {
namespace {

/// The nodes of the ground are not drawn: the stage passes their bends to the grass.
class GroundNodes : public SceneRenderer {
 public:
  void move_to(const pose::Pose&) override {}
  void draw(const meshes::View&) override {}
  bool is_field() const override { return true; }
  bool is_ground() const override { return true; }
};

std::unique_ptr<SceneRenderer> renderer_of(const pose::StrandSkeleton& strands, const wire::SceneModel& scene,
                                           look::Quality quality) {
  if (scene.kind == "fur") return std::make_unique<FurRenderer>(strands, quality);
  if (meshes::bend_grid_of(strands).columns > 0) return std::make_unique<GroundNodes>();
  return std::make_unique<GrassRenderer>(strands, grass_detail(quality));
}
std::unique_ptr<SceneRenderer> renderer_of(const pose::GridSkeleton& cloth, const wire::SceneModel& scene,
                                           look::Quality quality) {
  return std::make_unique<ClothRenderer>(cloth, scene.kind, scene.cloth, quality);
}
std::unique_ptr<SceneRenderer> renderer_of(const pose::TreeSkeleton& tree, const wire::SceneModel&,
                                           look::Quality quality) {
  return std::make_unique<TreeRenderer>(tree, quality);
}
std::unique_ptr<SceneRenderer> renderer_of(const pose::SurfaceSkeleton& surface, const wire::SceneModel&,
                                           look::Quality quality) {
  if (surface.ramp_rgba.empty()) return std::make_unique<WaterRenderer>(surface, quality);
  return std::make_unique<FlameRenderer>(surface, quality);
}

}  // namespace

std::unique_ptr<SceneRenderer> make_scene_renderer(const wire::SceneModel& scene, look::Quality quality) {
  return std::visit([&](const auto& kind) { return renderer_of(kind, scene, quality); }, scene.skeleton);
}

}  // namespace yuragi::viewer::looks
