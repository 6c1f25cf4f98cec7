#include "viewer/looks/grass_renderer.hpp"

#include "viewer/gl/shaders.hpp"

namespace yuragi {

GrassRenderer::GrassRenderer(const StrandSkeleton& strands)
    : ribbons_(strands, BladeStyle::kGrass), program_(link_program("grass", shaders::kGrassVert, shaders::kShadeFrag)) {
  set_sampler(program_, "joints", 0);
}

void GrassRenderer::move_to(const Pose& pose) {
  if (const auto* const bends = std::get_if<StrandPose>(&pose)) ribbons_.move_to(*bends);
}

void GrassRenderer::draw(const View& view) {
  ribbons_.draw(program_, view);
}

}  // namespace yuragi
