#include "viewer/looks/ground_maps.hpp"

#include <algorithm>
#include <array>

#include <glm/common.hpp>
#include <glm/mat2x2.hpp>
#include <glm/matrix.hpp>

#include "viewer/gl/noise_texture.hpp"

namespace yuragi::viewer::looks {
namespace {

// Unit 0 is left for the renderers' own textures.

void bind_texture(GLint unit, const gl::Texture& texture) {
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(GL_TEXTURE_2D, texture.name());
}

/// The mean of the first `count` bends.
glm::vec2 mean_of(const pose::StrandPose& pose, std::size_t count) {
  glm::dvec2 sum(0.0);
  for (std::size_t i = 0; i < count; ++i) sum += glm::dvec2(pose.bend_east_rad[i], pose.bend_south_rad[i]);
  return glm::vec2(sum / static_cast<double>(std::max<std::size_t>(count, 1)));
}

bool is_same(const meshes::Standing& a, const meshes::Standing& b) {
  return a.kind == b.kind && a.bounds.low_m == b.bounds.low_m && a.bounds.high_m == b.bounds.high_m &&
         a.opacity == b.opacity && a.blades == b.blades && a.floor == b.floor && a.shore == b.shore;
}

}  // namespace

GroundMaps::GroundMaps() : noise_(gl::make_noise_texture()), turf_(gl::make_turf_texture()) {
  for (const gl::Texture* texture : {&bends_, &growth_}) {
    glBindTexture(GL_TEXTURE_2D, texture->name());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    const GLint wrap = texture == &growth_ ? GL_CLAMP_TO_EDGE : GL_REPEAT;
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, wrap);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, wrap);
  }
  constexpr float side_m = meshes::GrowthMap::kSide_m;
  ground_.growth_place = {-0.5F * side_m, -0.5F * side_m, 1.0F / side_m, 1.0F / side_m};
  set_standing(
      {{.kind = meshes::Standing::Kind::kGrass, .bounds = {}, .opacity = 0.0F, .blades = nullptr, .floor = {}}});
  move_to({}, nullptr, nullptr, 0.0F);
}

void GroundMaps::set_samplers(const gl::Program& program) {
  gl::set_sampler(program, "noise_tile", gl::kNoiseUnit);
  gl::set_sampler(program, "turf_tile", gl::kTurfUnit);
  gl::set_sampler(program, "bends", gl::kBendsUnit);
  gl::set_sampler(program, "growth", gl::kGrowthUnit);
}

void GroundMaps::set_standing(const std::vector<meshes::Standing>& things, float most_growth) {
  if (std::ranges::equal(things, standing_, is_same) && most_growth == most_growth_) return;
  standing_ = things;
  most_growth_ = most_growth;
  map_.make(standing_, most_growth_);
  glBindTexture(GL_TEXTURE_2D, growth_.name());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  constexpr auto side = static_cast<GLsizei>(meshes::GrowthMap::kTexels);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, side, side, 0, GL_RGB, GL_UNSIGNED_BYTE, map_.texels().data());
}

void GroundMaps::move_to(const meshes::BendGrid& grid, const pose::StrandPose* nodes, const pose::StrandPose* near_by,
                         float near_by_share) {
  const bool is_streamed = nodes != nullptr && grid.columns > 0;
  glm::vec2 mean(0.0F);
  glm::mat2 sides_m(meshes::MeadowWaves::kSide_m);
  if (is_streamed) {
    columns_ = grid.columns;
    rows_ = grid.rows;
    texels_.resize(columns_ * rows_);
    for (std::size_t i = 0; i < texels_.size(); ++i) texels_[i] = {nodes->bend_east_rad[i], nodes->bend_south_rad[i]};
    mean = mean_of(*nodes, texels_.size());
    sides_m = glm::mat2(static_cast<float>(columns_) * grid.to_next_m, static_cast<float>(rows_) * grid.to_next_row_m);
  } else {
    columns_ = meshes::MeadowWaves::kNodes;
    rows_ = meshes::MeadowWaves::kNodes;
    texels_.resize(columns_ * rows_);
    mean = waves_.mean_bend();
    if (near_by != nullptr) mean = glm::mix(mean, mean_of(*near_by, near_by->bend_east_rad.size()), near_by_share);
    waves_.fill(mean, texels_);
  }
  // A node is at the centre of its texel.
  const glm::mat2 to_parts = glm::inverse(sides_m);
  const glm::vec2 corner_m =
      is_streamed ? grid.first_m - 0.5F * (grid.to_next_m + grid.to_next_row_m) : waves_.drifted_m();
  ground_.bends_place = {corner_m, is_streamed ? 0.0F : 1.0F, 0.0F};
  ground_.bends_axes = {to_parts[0], to_parts[1]};
  ground_.bend_mean = {mean, 0.0F, 0.0F};
  glBindTexture(GL_TEXTURE_2D, bends_.name());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RG16F, static_cast<GLsizei>(columns_), static_cast<GLsizei>(rows_), 0, GL_RG,
               GL_FLOAT, texels_.data());
}

glm::vec2 GroundMaps::bend_at(const glm::vec2& at_m) const {
  const glm::vec2 mean = mean_bend();
  if (ground_.bends_place.z > 0.0F) return mean;
  const glm::vec4& axes = ground_.bends_axes;
  const glm::vec2 uv = glm::mat2(axes.x, axes.y, axes.z, axes.w) * (at_m - glm::vec2(ground_.bends_place));
  const glm::vec2 within = glm::fract(uv);
  const glm::vec2 from_edge = 0.5F - glm::abs(within - 0.5F);
  const float sure = glm::smoothstep(0.0F, 0.09F, std::min(from_edge.x, from_edge.y));
  // Between the middles of texels, around the grid's edge.
  const glm::vec2 count(static_cast<float>(columns_), static_cast<float>(rows_));
  const glm::vec2 texel = within * count - 0.5F;
  const glm::vec2 low = glm::floor(texel);
  const glm::vec2 part = texel - low;
  const auto wrapped = [](float index, std::size_t size) {
    return (static_cast<std::size_t>(index + static_cast<float>(size))) % size;
  };
  const std::array columns{wrapped(low.x, columns_), wrapped(low.x + 1.0F, columns_)};
  const std::array rows{wrapped(low.y, rows_), wrapped(low.y + 1.0F, rows_)};
  const auto node = [&](std::size_t row, std::size_t column) {
    return texels_[rows.at(row) * columns_ + columns.at(column)];
  };
  const glm::vec2 bend =
      glm::mix(glm::mix(node(0, 0), node(0, 1), part.x), glm::mix(node(1, 0), node(1, 1), part.x), part.y);
  return glm::mix(mean, bend, sure);
}

void GroundMaps::bind(const meshes::Stand& stand, float tall, std::size_t door) {
  ground_.bend_mean.w = tall;
  ground_.stand = {stand.length_m, stand.curl_rad, static_cast<float>(door), stand.tilt_rad};
  gl::stream_to(GL_UNIFORM_BUFFER, block_, std::span<const meshes::Ground>(&ground_, 1));
  glBindBufferBase(GL_UNIFORM_BUFFER, gl::kGroundBinding, block_.name());
  bind_texture(gl::kNoiseUnit, noise_);
  bind_texture(gl::kTurfUnit, turf_);
  bind_texture(gl::kBendsUnit, bends_);
  bind_texture(gl::kGrowthUnit, growth_);
  glActiveTexture(GL_TEXTURE0);
}

}  // namespace yuragi::viewer::looks
