#include "viewer/looks/strand_ribbons.hpp"

namespace yuragi::viewer::looks {

static_assert(sizeof(meshes::Blade) == 3 * 4 * sizeof(float));

StrandRibbons::StrandRibbons(const pose::StrandSkeleton& strands, GLint copies)
    : strands_(&strands), copies_(copies), sorter_(strands), joints_(strands) {
  glBindBuffer(GL_TEXTURE_BUFFER, joint_buffer_.name());  // creates the buffer, even if no pose is ever taken
}

void StrandRibbons::move_to(const pose::StrandPose& pose) {
  // The forward kinematics of engine/pose; its joints are uploaded in the same order.
  const pose::StrandKinematicsJob job{.skeleton = strands_, .pose = &pose, .row = {}, .joints = &joints_};
  if (job.run() != pose::StrandKinematicsJob::Problem::kNone) return;
  gl::stream_to(GL_TEXTURE_BUFFER, joint_buffer_, std::span(std::as_const(joints_).data()));
}

void StrandRibbons::draw(const gl::Program& program, const meshes::View& view) {
  glUseProgram(program.name());
  glUniform1i(glGetUniformLocation(program.name(), "links"), static_cast<GLint>(strands_->links_per_strand));
  const GLint copies_place = glGetUniformLocation(program.name(), "copies");
  const GLint rings_place = glGetUniformLocation(program.name(), "rings");
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_BUFFER, joint_texture_.name());
  glTexBuffer(GL_TEXTURE_BUFFER, GL_R32F, joint_buffer_.name());

  // Near blades first: then the depth test avoids painting hidden parts.
  sorter_.sort(view);
  for (const meshes::DetailLevel& level : sorter_.levels()) {
    if (level.blades.empty()) continue;
    gl::stream_to(GL_TEXTURE_BUFFER, blade_buffer_, std::span(level.blades));
    glActiveTexture(GL_TEXTURE0 + gl::kStripsUnit);
    glBindTexture(GL_TEXTURE_BUFFER, blade_texture_.name());
    glTexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, blade_buffer_.name());
    const GLint copies = level.is_far ? 1 : copies_;
    glUniform1i(copies_place, copies);
    glUniform1i(rings_place, static_cast<GLint>(level.rings));
    strips_.draw(2 * (level.rings + 1), level.blades.size() * static_cast<std::size_t>(copies));
  }
  glActiveTexture(GL_TEXTURE0);
}

}  // namespace yuragi::viewer::looks
