#include "viewer/looks/grass_look.hpp"

#include "viewer/gl/shaders.hpp"

namespace yuragi {

GrassLook::GrassLook(const StrandSkeleton& strands)
    : ribbons_(strands, BladeStyle::kGrass), program_(link_program("grass", shaders::kGrassVert, shaders::kShadeFrag)) {
  set_sampler(program_, "joints", 0);
}

void GrassLook::move_to(const Pose& pose) {
  if (const auto* const bends = std::get_if<StrandPose>(&pose)) ribbons_.move_to(*bends);
}

void GrassLook::draw(const View& view) {
  ribbons_.draw(program_, view);
}

}  // namespace yuragi
