#include "viewer/looks/sward.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "viewer/gl/shaders.hpp"
#include "viewer/looks/ground_maps.hpp"

namespace yuragi::viewer::looks {
namespace {

constexpr float kLawnReach_m = 18.0F;
constexpr float kLawnLength_m = 0.085F;  // sward.part.glsl has the same
constexpr float kLawnHeight_m = 0.2F;
constexpr float kLawnBlades_per_m2 = 2200.0F;
constexpr float kLawnDrawn = 1.8F;         // number of blades relative to tall grass: they have fewer vertices
constexpr float kHighest = 2.2F;           // of the mean length
constexpr float kWidthPerSpacing = 0.26F;  // as for streamed blades (blades.cpp)
constexpr float kLawnWidth_m = 0.004F;

/// A lawn's blades are short: they are drawn to a shorter distance, and stand closer.
meshes::GrassDetail detail_of(Sward::Kind kind, meshes::GrassDetail detail) {
  if (kind == Sward::Kind::kLawn) {
    detail.reach_m = std::min(detail.reach_m, kLawnReach_m);
    detail.drawn_at_1m_per_m2 *= kLawnDrawn;
  }
  return detail;
}

/// `detail`: of this kind.
meshes::Thinning thinning_of(Sward::Kind kind, const meshes::Stand& stand, const meshes::GrassDetail& detail) {
  return {.blades_per_m2 = kind == Sward::Kind::kTall ? stand.blades_per_m2 : kLawnBlades_per_m2,
          .drawn_at_1m_per_m2 = detail.drawn_at_1m_per_m2};
}

meshes::SwardTiles tiles_of(Sward::Kind kind, std::size_t blades, const meshes::Stand& stand,
                            const meshes::GrassDetail& detail) {
  const float length_m = kind == Sward::Kind::kTall ? stand.length_m : kLawnLength_m;
  const float height_m = kind == Sward::Kind::kTall ? kHighest * stand.length_m : kLawnHeight_m;
  return {blades, thinning_of(kind, stand, detail), detail, length_m, height_m};
}

float width_m_of(Sward::Kind kind, const meshes::Stand& stand) {
  if (kind == Sward::Kind::kLawn) return kLawnWidth_m;
  return std::clamp(kWidthPerSpacing / std::sqrt(stand.blades_per_m2), 0.012F * stand.length_m,
                    0.055F * stand.length_m);
}

std::size_t rings_of(std::size_t level) {
  return meshes::SwardTiles::kLevels - level;
}

std::size_t blades_a_tile(const meshes::Thinning& thinning) {
  return static_cast<std::size_t>(thinning.blades_per_m2 * meshes::SwardTiles::kTile_m * meshes::SwardTiles::kTile_m);
}

}  // namespace

const meshes::GrassDetail& grass_detail(look::Quality quality) {
  if (quality == look::Quality::kLow) return meshes::kLittleGrass;
  return quality == look::Quality::kMedium ? meshes::kMediumGrass : meshes::kMuchGrass;
}

Sward::Sward(Kind kind, const meshes::Stand& stand, const meshes::GrassDetail& detail)
    : kind_(kind),
      detail_(detail_of(kind, detail)),
      thinning_(thinning_of(kind, stand, detail_)),
      blades_per_tile_(blades_a_tile(thinning_)),
      tiles_(tiles_of(kind, blades_per_tile_, stand, detail_)),
      program_(gl::link_program("sward", gl::shaders::kSwardVert, gl::shaders::kShadeFrag)) {
  GroundMaps::set_samplers(program_);
  gl::set_sampler(program_, "blades", gl::kBladesUnit);
  gl::set_sampler(program_, "tiles", gl::kTilesUnit);
  const auto place = [this](const char* name) { return glGetUniformLocation(program_.name(), name); };
  glUniform1i(place("blades_per_tile"), static_cast<GLint>(blades_per_tile_));
  glUniform1f(place("tile_m"), meshes::SwardTiles::kTile_m);
  glUniform1f(place("reach_m"), detail_.reach_m);
  glUniform1f(place("width_m"), width_m_of(kind, stand));
  glUniform1f(place("tall"), kind == Kind::kTall ? 1.0F : 0.0F);

  const std::vector<meshes::SwardBlade> blades = meshes::sward_blades(blades_per_tile_);
  blades_.fill(std::span(blades));
  first_corner_place_ = place("first_corner");
  glBindVertexArray(array_.name());
  for (std::size_t level = 0; level < triangles_.size(); ++level) {
    const std::vector<std::uint32_t> triangles = meshes::ribbon_triangles(blades_per_tile_, rings_of(level));
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, triangles_[level].name());
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(std::span(triangles).size_bytes()), triangles.data(),
                 GL_STATIC_DRAW);
  }
}

void Sward::set_blade_share(float share) {
  thinning_.drawn_at_1m_per_m2 = share * detail_.drawn_at_1m_per_m2;
  tiles_.set_thinning(thinning_);
}

void Sward::draw(const meshes::View& view, const meshes::GrowthMap& growth) {
  tiles_.choose(view, [&](const glm::vec2& low_m, const glm::vec2& high_m) {
    return growth.is_free(low_m, high_m, kind_ == Kind::kTall);
  });
  glUseProgram(program_.name());
  glUniform1f(glGetUniformLocation(program_.name(), "thinning"), thinning_.factor());
  glBindVertexArray(array_.name());
  drawn_.clear();
  for (std::size_t level = 0; level < triangles_.size(); ++level) {
    drawn_.insert(drawn_.end(), tiles_.level(level).begin(), tiles_.level(level).end());
  }
  tiles_on_gpu_.fill(std::span(std::as_const(drawn_)));
  blades_.bind(gl::kBladesUnit);
  tiles_on_gpu_.bind(gl::kTilesUnit);
  glActiveTexture(GL_TEXTURE0);
  std::size_t slot = 0;
  for (std::size_t level = 0; level < triangles_.size(); ++level) {
    const std::span<const meshes::SwardTile> tiles = tiles_.level(level);
    if (tiles.empty()) continue;
    const std::size_t rings = rings_of(level);
    glUniform1i(glGetUniformLocation(program_.name(), "rings"), static_cast<GLint>(rings));
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, triangles_[level].name());
    for (const meshes::SwardTile& tile : tiles) {
      glUniform1i(first_corner_place_, static_cast<GLint>(slot * blades_per_tile_ * (2 * rings + 1)));
      glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(static_cast<std::size_t>(tile.blades) * 3 * (2 * rings - 1)),
                     GL_UNSIGNED_INT, nullptr);
      ++slot;
    }
  }
}

}  // namespace yuragi::viewer::looks
