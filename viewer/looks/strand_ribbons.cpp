#include "viewer/looks/strand_ribbons.hpp"

#include <cstddef>

namespace yuragi::viewer::looks {
namespace {

constexpr GLuint kAttributes = 4;

void describe_blade(const gl::GlVertexArray& array, const gl::GlBuffer& buffer) {
  // OpenGL takes an offset in a buffer as a pointer.
  // NOLINTNEXTLINE(performance-no-int-to-ptr)
  const auto at = [](std::size_t offset) { return reinterpret_cast<const void*>(offset); };
  glBindVertexArray(array.name());
  glBindBuffer(GL_ARRAY_BUFFER, buffer.name());
  glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, sizeof(meshes::Blade), at(offsetof(meshes::Blade, root_m)));
  glVertexAttribPointer(1, 4, GL_FLOAT, GL_FALSE, sizeof(meshes::Blade), at(offsetof(meshes::Blade, tint)));
  glVertexAttribIPointer(2, 1, GL_UNSIGNED_INT, sizeof(meshes::Blade), at(offsetof(meshes::Blade, strand)));
  glVertexAttribPointer(3, 1, GL_FLOAT, GL_FALSE, sizeof(meshes::Blade), at(offsetof(meshes::Blade, length_m)));
  for (GLuint attribute = 0; attribute < kAttributes; ++attribute) {
    glEnableVertexAttribArray(attribute);
  }
}

}  // namespace

StrandRibbons::StrandRibbons(const pose::StrandSkeleton& strands, GLint copies)
    : strands_(&strands), copies_(copies), sorter_(strands), joints_(strands) {
  describe_blade(blade_array_, blade_buffer_);
  glBindBuffer(GL_TEXTURE_BUFFER, joint_buffer_.name());  // creates the buffer, even if no pose is ever taken
}

void StrandRibbons::move_to(const pose::StrandPose& pose) {
  // The forward kinematics of engine/pose; its joints are uploaded as they lie.
  const pose::StrandKinematicsJob job{.skeleton = strands_, .pose = &pose, .row = {}, .joints = &joints_};
  if (job.run() != pose::StrandKinematicsJob::Problem::kNone) return;
  gl::stream_to(GL_TEXTURE_BUFFER, joint_buffer_, std::span(std::as_const(joints_).data()));
}

void StrandRibbons::draw(const gl::GlProgram& program, const meshes::View& view) {
  glUseProgram(program.name());
  glUniform1i(glGetUniformLocation(program.name(), "links"), static_cast<GLint>(strands_->links_per_strand));
  const GLint copies_place = glGetUniformLocation(program.name(), "copies");
  const GLint rings_place = glGetUniformLocation(program.name(), "rings");
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_BUFFER, joint_texture_.name());
  glTexBuffer(GL_TEXTURE_BUFFER, GL_R32F, joint_buffer_.name());

  // Near blades first: the depth test then saves painting what they hide.
  sorter_.sort(view);
  glBindVertexArray(blade_array_.name());
  for (const meshes::DetailLevel& level : sorter_.levels()) {
    if (level.blades.empty()) continue;
    gl::stream_to(GL_ARRAY_BUFFER, blade_buffer_, std::span(level.blades));
    const GLint copies = level.is_far ? 1 : copies_;
    for (GLuint attribute = 0; attribute < kAttributes; ++attribute) {
      glVertexAttribDivisor(attribute, static_cast<GLuint>(copies));
    }
    glUniform1i(copies_place, copies);
    glUniform1i(rings_place, static_cast<GLint>(level.rings));
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, static_cast<GLsizei>(2 * (level.rings + 1)),
                          static_cast<GLsizei>(level.blades.size()) * copies);
  }
}

}  // namespace yuragi::viewer::looks
