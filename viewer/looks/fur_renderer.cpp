#include "viewer/looks/fur_renderer.hpp"

#include <cstddef>

#include "viewer/gl/noise_texture.hpp"
#include "viewer/gl/shaders.hpp"
#include "viewer/meshes/body.hpp"

namespace yuragi::viewer::looks {
namespace {

/// Hairs a strand.
GLint hairs_of(look::Quality quality) {
  if (quality == look::Quality::kLow) return 3;
  return quality == look::Quality::kMedium ? 6 : 10;
}

void set_body(const gl::GlProgram& program, const meshes::Body& body) {
  glUseProgram(program.name());
  glUniform3f(glGetUniformLocation(program.name(), "body_middle_m"), body.middle_m.x, body.middle_m.y, body.middle_m.z);
  glUniformMatrix3fv(glGetUniformLocation(program.name(), "body_shape"), 1, GL_FALSE, &body.shape[0][0]);
}

}  // namespace

FurRenderer::FurRenderer(const pose::StrandSkeleton& strands, look::Quality quality)
    : ribbons_(strands, hairs_of(quality)),
      hair_(gl::link_program("hair", gl::shaders::kHairVert, gl::shaders::kShadeFrag)),
      skin_(gl::link_program("skin", gl::shaders::kSkinVert, gl::shaders::kSkinFrag)),
      noise_(gl::make_noise_texture()),
      limb_(gl::link_program("limb", gl::shaders::kLimbVert, gl::shaders::kLimbFrag)) {
  gl::set_sampler(hair_, "joints", 0);
  gl::set_sampler(hair_, "blades", gl::kStripsUnit);
  gl::set_sampler(skin_, "noise_tile", 0);
  gl::set_sampler(limb_, "noise_tile", 0);
  const meshes::Body body = meshes::body_of(strands);
  limbs_ = meshes::limbs_of(strands, body);
  if (!limbs_.indices.empty()) make_limbs();
  set_body(hair_, body);
  glUniform1f(glGetUniformLocation(hair_.name(), "spacing_m"), body.spacing_m);
  set_body(skin_, body);

  if (strands.strand_count == 0) return;
  const meshes::Skin skin = meshes::skin_of(body);
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

void FurRenderer::make_limbs() {
  constexpr GLsizei kStride = sizeof(meshes::LimbVertex);
  // OpenGL takes an offset in a buffer as a pointer.
  // NOLINTNEXTLINE(performance-no-int-to-ptr)
  const auto at = [](std::size_t offset) { return reinterpret_cast<const void*>(offset); };
  glBindVertexArray(limb_array_.name());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, limb_indices_.name());
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(limbs_.indices.size() * sizeof(std::uint32_t)),
               limbs_.indices.data(), GL_STATIC_DRAW);
  glBindBuffer(GL_ARRAY_BUFFER, limb_buffer_.name());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(limbs_.vertices.size()) * kStride, limbs_.vertices.data(),
               GL_STATIC_DRAW);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, kStride, at(offsetof(meshes::LimbVertex, place_m)));
  glVertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, kStride, at(offsetof(meshes::LimbVertex, normal)));
  glVertexAttribPointer(2, 3, GL_FLOAT, GL_FALSE, kStride, at(offsetof(meshes::LimbVertex, tint)));
  glVertexAttribPointer(3, 2, GL_FLOAT, GL_FALSE, kStride, at(offsetof(meshes::LimbVertex, hair_m)));
  for (const GLuint attribute : {0U, 1U, 2U, 3U}) glEnableVertexAttribArray(attribute);
}

meshes::Bounds FurRenderer::bounds_with_holder(const meshes::Bounds& bounds) const {
  meshes::Bounds with_limbs = bounds;
  for (const meshes::LimbVertex& vertex : limbs_.vertices) {
    with_limbs = meshes::united(with_limbs, {vertex.place_m, vertex.place_m});
  }
  return with_limbs;
}

void FurRenderer::move_to(const pose::Pose& pose) {
  if (const auto* const bends = std::get_if<pose::StrandPose>(&pose)) ribbons_.move_to(*bends);
}

void FurRenderer::draw(const meshes::View& view) {
  ribbons_.draw(hair_, view);
  draw_skin();
}

void FurRenderer::draw_shadow(const meshes::View& view) {
  // A body's shadow on the ground does as well without its hairs; in a map they shade each other.
  const bool is_map = view.to_clip[0][3] == 0.0F && view.to_clip[1][3] == 0.0F && view.to_clip[2][3] == 0.0F;
  if (is_map) ribbons_.draw(hair_, view);
  draw_skin();
}

void FurRenderer::draw_skin() const {
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, noise_.name());
  glUseProgram(skin_.name());
  glBindVertexArray(skin_array_.name());
  glDrawElements(GL_TRIANGLES, skin_count_, GL_UNSIGNED_INT, nullptr);
  if (limbs_.indices.empty()) return;
  glUseProgram(limb_.name());
  glBindVertexArray(limb_array_.name());
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(limbs_.indices.size()), GL_UNSIGNED_INT, nullptr);
}

}  // namespace yuragi::viewer::looks
