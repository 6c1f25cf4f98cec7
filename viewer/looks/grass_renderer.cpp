#include "viewer/looks/grass_renderer.hpp"

#include <algorithm>

#include "viewer/gl/shaders.hpp"
#include "viewer/looks/ground_maps.hpp"
#include "viewer/meshes/sward.hpp"

namespace yuragi::viewer::looks {
GrassRenderer::GrassRenderer(const pose::StrandSkeleton& strands, const meshes::GrassDetail& detail)
    : detail_(detail),
      thinning_{.blades_per_m2 = meshes::stand_of(strands).blades_per_m2,
                .drawn_at_1m_per_m2 = detail.drawn_at_1m_per_m2},
      tiles_(strands, thinning_, detail),
      program_(gl::link_program("grass", gl::shaders::kGrassVert, gl::shaders::kShadeFrag)),
      triangles_(tiles_.levels().size()) {
  GroundMaps::set_samplers(program_);
  gl::set_sampler(program_, "streamed_bends", 0);
  gl::set_sampler(program_, "blades", gl::kBladesUnit);
  gl::set_sampler(program_, "blocks", gl::kTilesUnit);
  glUniform1f(glGetUniformLocation(program_.name(), "reach_m"), detail.reach_m);
  first_corner_place_ = glGetUniformLocation(program_.name(), "first_corner");
  blades_.fill(tiles_.blades());
  glBindVertexArray(array_.name());
  for (std::size_t level = 0; level < triangles_.size(); ++level) {
    const std::vector<std::uint32_t> triangles =
        meshes::ribbon_triangles(tiles_.most_strands_a_tile(), tiles_.levels()[level].rings);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, triangles_[level].name());
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(std::span(triangles).size_bytes()), triangles.data(),
                 GL_STATIC_DRAW);
  }
}

void GrassRenderer::move_to(const pose::Pose& pose) {
  latest_ = std::get_if<pose::StrandPose>(&pose);
}

void GrassRenderer::set_blade_share(float share) {
  thinning_.drawn_at_1m_per_m2 = share * detail_.drawn_at_1m_per_m2;
  tiles_.set_thinning(thinning_);
}

void GrassRenderer::draw(const meshes::View& view) {
  tiles_.choose(view);
  if (tiles_.blocks().empty() || latest_ == nullptr) return;
  bends_.fill(tiles_.bends(*latest_));
  blocks_.fill(tiles_.blocks());
  glUseProgram(program_.name());
  glUniform1f(glGetUniformLocation(program_.name(), "thinning"), thinning_.factor());
  glBindVertexArray(array_.name());
  blades_.bind(gl::kBladesUnit);
  blocks_.bind(gl::kTilesUnit);
  bends_.bind(0);
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    const meshes::StrandTiles::Level& level = tiles_.levels()[i];
    if (level.tiles.empty()) continue;
    glUniform1i(glGetUniformLocation(program_.name(), "rings"), static_cast<GLint>(level.rings));
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, triangles_[i].name());
    for (const meshes::StrandTiles::Drawn& tile : level.tiles) {
      glUniform1i(first_corner_place_, static_cast<GLint>(tile.first_slot * (2 * level.rings + 1)));
      glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(tile.strands * 3 * (2 * level.rings - 1)), GL_UNSIGNED_INT,
                     nullptr);
    }
  }
}

}  // namespace yuragi::viewer::looks
