#include "viewer/looks/fur_renderer.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <glm/geometric.hpp>

#include "viewer/gl/noise_texture.hpp"
#include "viewer/gl/shaders.hpp"

namespace yuragi::viewer::looks {
namespace {

// Size of a limb's hairs in the picture: shorter ones are not drawn; of those shorter than kAllHairs_px a part is
// drawn, wider.
constexpr float kMinHair_px = 2.0F;
constexpr float kAllHairs_px = 12.0F;

/// Hairs a strand.
GLint hairs_of(look::Quality quality) {
  if (quality == look::Quality::kLow) return 3;
  return quality == look::Quality::kMedium ? 6 : 10;
}

void set_body(const gl::Program& program, const meshes::Body& body) {
  glUseProgram(program.name());
  glUniform3f(glGetUniformLocation(program.name(), "body_middle_m"), body.middle_m.x, body.middle_m.y, body.middle_m.z);
  glUniformMatrix3fv(glGetUniformLocation(program.name(), "body_shape"), 1, GL_FALSE, &body.shape[0][0]);
}

}  // namespace

FurRenderer::FurRenderer(const pose::StrandSkeleton& strands, look::Quality quality)
    : do_hairs_shade_(quality != look::Quality::kLow),
      body_(meshes::body_of(strands)),
      ribbons_(strands, hairs_of(quality)),
      partings_(strands, body_),
      hair_(gl::link_program("hair", gl::shaders::kHairVert, gl::shaders::kShadeFrag)),
      skin_(gl::link_program("skin", gl::shaders::kSkinVert, gl::shaders::kSkinFrag)),
      noise_(gl::make_noise_texture()),
      limb_(gl::link_program("limb", gl::shaders::kLimbVert, gl::shaders::kLimbFrag)) {
  gl::set_sampler(hair_, "joints", 0);
  gl::set_sampler(hair_, "blades", gl::kStripsUnit);
  gl::set_sampler(skin_, "noise_tile", 0);
  gl::set_sampler(limb_, "noise_tile", 0);
  is_hair_ = glGetUniformLocation(limb_.name(), "is_hair");
  wider_ = glGetUniformLocation(limb_.name(), "wider");
  const meshes::Limbs limbs = meshes::limbs_of(strands, body_);
  if (!limbs.indices.empty()) make_limbs(limbs);
  set_body(hair_, body_);
  glUniform1f(glGetUniformLocation(hair_.name(), "spacing_m"), body_.spacing_m);
  set_body(skin_, body_);

  if (strands.strand_count == 0) return;
  const meshes::Skin skin = meshes::skin_of(body_);
  skin_count_ = static_cast<GLsizei>(skin.triangles.size());
  glBindVertexArray(skin_array_.name());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, skin_indices_.name());
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(skin.triangles.size() * sizeof(std::uint32_t)),
               skin.triangles.data(), GL_STATIC_DRAW);
  glBindBuffer(GL_ARRAY_BUFFER, skin_buffer_.name());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(skin.places_m.size() * sizeof(glm::vec3)), skin.places_m.data(),
               GL_STATIC_DRAW);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(glm::vec3), nullptr);
  glEnableVertexAttribArray(0);
}

void FurRenderer::make_limbs(const meshes::Limbs& limbs) {
  constexpr GLsizei kStride = sizeof(meshes::LimbVertex);
  // OpenGL takes an offset in a buffer as a pointer.
  // NOLINTNEXTLINE(performance-no-int-to-ptr)
  const auto at = [](std::size_t offset) { return reinterpret_cast<const void*>(offset); };
  glBindVertexArray(limb_array_.name());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, limb_indices_.name());
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(limbs.indices.size() * sizeof(std::uint32_t)),
               limbs.indices.data(), GL_STATIC_DRAW);
  glBindBuffer(GL_ARRAY_BUFFER, limb_buffer_.name());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(limbs.vertices.size()) * kStride, limbs.vertices.data(),
               GL_STATIC_DRAW);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, kStride, at(offsetof(meshes::LimbVertex, place_m)));
  glVertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, kStride, at(offsetof(meshes::LimbVertex, normal)));
  glVertexAttribPointer(2, 3, GL_FLOAT, GL_FALSE, kStride, at(offsetof(meshes::LimbVertex, tint)));
  glVertexAttribPointer(3, 2, GL_FLOAT, GL_FALSE, kStride, at(offsetof(meshes::LimbVertex, hair_m)));
  glVertexAttribPointer(4, 3, GL_FLOAT, GL_FALSE, kStride, at(offsetof(meshes::LimbVertex, aside_m)));
  for (const GLuint attribute : {0U, 1U, 2U, 3U, 4U}) glEnableVertexAttribArray(attribute);

  limb_count_ = static_cast<GLsizei>(limbs.skin_count);
  limb_hair_count_ = static_cast<GLsizei>((limbs.indices.size() - limbs.skin_count) / 3);
  limb_hair_m_ = limbs.hair_m;
  const glm::vec3 first_m = limbs.vertices.front().place_m;
  limb_bounds_ = meshes::Bounds{first_m, first_m};
  for (const meshes::LimbVertex& vertex : limbs.vertices) {
    limb_bounds_ = meshes::united(*limb_bounds_, {vertex.place_m, vertex.place_m});
  }
}

void FurRenderer::move_to(const pose::Pose& pose) {
  const auto* const bends = std::get_if<pose::StrandPose>(&pose);
  if (bends == nullptr) return;
  ribbons_.move_to(*bends);
  partings_.move_to(ribbons_.joints());
  ribbons_.set_openings(partings_.openings());
}

void FurRenderer::draw(const meshes::View& view) {
  ribbons_.draw(hair_, view);
  const float distance_m = glm::distance(glm::vec3(view.eye_m), body_.middle_m);
  const float hair_px = limb_hair_m_ / (view.eye_m.w * std::max(distance_m, 1e-3F));
  const float part = std::min(hair_px / kAllHairs_px, 1.0F);
  draw_skin(hair_px > kMinHair_px ? part * part : 0.0F);
}

void FurRenderer::draw_shadow(const meshes::View& view) {
  // The ground receives no shadow from them; but hairs shade each other if they receive shadows.
  if (do_hairs_shade_) ribbons_.draw(hair_, view);
  draw_skin(0.0F);
}

void FurRenderer::draw_skin(float hair_share) const {
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, noise_.name());
  glUseProgram(skin_.name());
  glBindVertexArray(skin_array_.name());
  glDrawElements(GL_TRIANGLES, skin_count_, GL_UNSIGNED_INT, nullptr);
  if (limb_count_ == 0) return;
  glUseProgram(limb_.name());
  glBindVertexArray(limb_array_.name());
  glUniform1i(is_hair_, 0);
  glUniform1f(wider_, 1.0F);
  glDrawElements(GL_TRIANGLES, limb_count_, GL_UNSIGNED_INT, nullptr);
  const GLsizei hairs = static_cast<GLsizei>(hair_share * static_cast<float>(limb_hair_count_));
  if (hairs == 0) return;
  glUniform1i(is_hair_, 1);
  glUniform1f(wider_, 1.0F / std::sqrt(hair_share));
  // OpenGL takes an offset in a buffer as a pointer.
  // NOLINTNEXTLINE(performance-no-int-to-ptr)
  const auto* const at = reinterpret_cast<const void*>(static_cast<std::size_t>(limb_count_) * sizeof(std::uint32_t));
  glDrawElements(GL_TRIANGLES, 3 * hairs, GL_UNSIGNED_INT, at);
}

}  // namespace yuragi::viewer::looks
