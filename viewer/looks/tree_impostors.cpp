#include "viewer/looks/tree_impostors.hpp"

#include <array>
#include <cstddef>
#include <stdexcept>

#include "viewer/gl/shaders.hpp"

namespace yuragi::viewer::looks {
namespace {

constexpr int kPicture_px = 256;
constexpr int kWidth_px = kPicture_px * static_cast<int>(meshes::trees::kImpostorSides);
constexpr int kHeight_px = kPicture_px * static_cast<int>(meshes::trees::kImpostorRows);
constexpr int kMinLevel = 5;  // a picture is 8 pixels wide at that level

const void* offset_in_tree(std::size_t offset) {
  return reinterpret_cast<const void*>(offset);  // NOLINT(performance-no-int-to-ptr)
}

void make_atlas(GLint unit, const gl::Texture& texture) {
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(GL_TEXTURE_2D, texture.name());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, kWidth_px, kHeight_px, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, kMinLevel);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glBindTexture(GL_TEXTURE_2D, 0);
  glActiveTexture(GL_TEXTURE0);
}

}  // namespace

void LeafColors::set(const gl::Program& program) const {
  glUniform1i(glGetUniformLocation(program.name(), "has_palette"), has_palette ? 1 : 0);
  glUniform1f(glGetUniformLocation(program.name(), "turns_red"), turns_red);
  glUniform1f(glGetUniformLocation(program.name(), "silver"), silver);
}

TreeImpostors::TreeImpostors(const meshes::trees::ImpostorBox& box, const glm::vec3& foot_m,
                             meshes::trees::SprayShape::Kind kind, const LeafColors& colors)
    : box_(box),
      to_middle_m_(box.middle_m - foot_m),
      kind_(kind),
      colors_(colors),
      program_(gl::link_program("impostor", gl::shaders::kImpostorVert, gl::shaders::kImpostorFrag)) {
  make_atlas(gl::kImpostorUnit, looks_);
  make_atlas(gl::kImpostorFacingUnit, facing_);
  gl::set_sampler(program_, "looks", gl::kImpostorUnit);
  gl::set_sampler(program_, "facing", gl::kImpostorFacingUnit);

  using Tree = meshes::trees::Impostor;
  glBindVertexArray(array_.name());
  glBindBuffer(GL_ARRAY_BUFFER, trees_.name());
  for (GLuint attribute = 0; attribute < 3; ++attribute) {
    glEnableVertexAttribArray(attribute);
    glVertexAttribDivisor(attribute, 1);
  }
  glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, sizeof(Tree), offset_in_tree(offsetof(Tree, foot_scale)));
  glVertexAttribPointer(1, 4, GL_FLOAT, GL_FALSE, sizeof(Tree), offset_in_tree(offsetof(Tree, turn_sway)));
  glVertexAttribPointer(2, 3, GL_FLOAT, GL_FALSE, sizeof(Tree), offset_in_tree(offsetof(Tree, share)));
}

void TreeImpostors::begin() {
  canvas_.emplace();
  glBindFramebuffer(GL_FRAMEBUFFER, canvas_->framebuffer.name());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, looks_.name(), 0);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT1, GL_TEXTURE_2D, facing_.name(), 0);
  glBindRenderbuffer(GL_RENDERBUFFER, canvas_->depth.name());
  glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, kWidth_px, kHeight_px);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, canvas_->depth.name());
  constexpr std::array<GLenum, 2> kBoth{GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
  glDrawBuffers(2, kBoth.data());
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw std::runtime_error("the graphics driver cannot draw the pictures of far trees");
  }
  glDisable(GL_BLEND);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_STENCIL_TEST);
  glDisable(GL_CULL_FACE);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  constexpr std::array<GLfloat, 4> kNothing{};
  constexpr GLfloat kFarthest = 1.0F;
  glClearBufferfv(GL_COLOR, 0, kNothing.data());
  glClearBufferfv(GL_COLOR, 1, kNothing.data());
  glClearBufferfv(GL_DEPTH, 0, &kFarthest);
}

meshes::View TreeImpostors::begin_picture(gl::ViewBuffer& views, std::size_t side, std::size_t row) {
  glViewport(kPicture_px * static_cast<int>(side), kPicture_px * static_cast<int>(row), kPicture_px, kPicture_px);
  const meshes::View view = meshes::trees::impostor_view(box_, side, row, kPicture_px);
  views.set(view);
  return view;
}

void TreeImpostors::end() {
  canvas_.reset();
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  for (const gl::Texture* texture : {&looks_, &facing_}) {
    glBindTexture(GL_TEXTURE_2D, texture->name());
    glGenerateMipmap(GL_TEXTURE_2D);
  }
  glBindTexture(GL_TEXTURE_2D, 0);
}

void TreeImpostors::draw(std::span<const meshes::trees::Impostor> trees, float blown, bool is_by_sun) {
  if (trees.empty()) return;
  glActiveTexture(GL_TEXTURE0 + gl::kImpostorUnit);
  glBindTexture(GL_TEXTURE_2D, looks_.name());
  glActiveTexture(GL_TEXTURE0 + gl::kImpostorFacingUnit);
  glBindTexture(GL_TEXTURE_2D, facing_.name());
  glActiveTexture(GL_TEXTURE0);
  glUseProgram(program_.name());
  glUniform3f(glGetUniformLocation(program_.name(), "to_middle_m"), to_middle_m_.x, to_middle_m_.y, to_middle_m_.z);
  glUniform2f(glGetUniformLocation(program_.name(), "half_m"), box_.half_width_m, box_.half_height_m);
  glUniform1i(glGetUniformLocation(program_.name(), "is_by_sun"), is_by_sun ? 1 : 0);
  glUniform1i(glGetUniformLocation(program_.name(), "kind"), static_cast<GLint>(kind_));
  colors_.set(program_);
  glUniform1f(glGetUniformLocation(program_.name(), "blown"), blown);
  glUniform1f(glGetUniformLocation(program_.name(), "side_px"), static_cast<float>(kPicture_px));
  glBindVertexArray(array_.name());
  gl::stream_to(GL_ARRAY_BUFFER, trees_, trees);
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(trees.size()));
}

}  // namespace yuragi::viewer::looks
