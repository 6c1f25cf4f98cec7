#include "viewer/looks/grass_renderer.hpp"

#include "viewer/gl/shaders.hpp"

namespace yuragi::viewer::looks {

GrassRenderer::GrassRenderer(const pose::StrandSkeleton& strands)
    : ribbons_(strands, meshes::BladeStyle::kGrass),
      program_(gl::link_program("grass", gl::shaders::kGrassVert, gl::shaders::kShadeFrag)) {
  gl::set_sampler(program_, "joints", 0);
}

void GrassRenderer::move_to(const pose::Pose& pose) {
  if (const auto* const bends = std::get_if<pose::StrandPose>(&pose)) ribbons_.move_to(*bends);
}

void GrassRenderer::draw(const meshes::View& view) {
  ribbons_.draw(program_, view);
}

}  // namespace yuragi::viewer::looks
