#include "viewer/looks/strand_ribbons.hpp"

#include <utility>

namespace yuragi::viewer::looks {

static_assert(sizeof(meshes::Blade) == 3 * 4 * sizeof(float));

StrandRibbons::StrandRibbons(const pose::StrandSkeleton& strands, GLint copies)
    : strands_(&strands), copies_(copies), sorter_(strands), joints_(strands) {}

void StrandRibbons::move_to(const pose::StrandPose& pose) {
  // The forward kinematics of engine/pose; its joints are uploaded in the same order.
  const pose::StrandKinematicsJob job{.skeleton = strands_, .pose = &pose, .row = {}, .joints = &joints_};
  if (job.run() != pose::StrandKinematicsJob::Problem::kNone) return;
  joints_on_gpu_.fill(std::span(std::as_const(joints_).data()));
}

void StrandRibbons::draw(const gl::Program& program, const meshes::View& view) {
  glUseProgram(program.name());
  glUniform1i(glGetUniformLocation(program.name(), "links"), static_cast<GLint>(strands_->links_per_strand));
  const GLint copies_place = glGetUniformLocation(program.name(), "copies");
  const GLint rings_place = glGetUniformLocation(program.name(), "rings");
  const GLint first_corner_place = glGetUniformLocation(program.name(), "first_corner");

  // Near blades first: then the depth test avoids painting hidden parts.
  sorter_.sort(view);
  blades_.clear();
  for (const meshes::DetailLevel& level : sorter_.levels()) {
    blades_.insert(blades_.end(), level.blades.begin(), level.blades.end());
  }
  blades_on_gpu_.fill(std::span(std::as_const(blades_)));
  blades_on_gpu_.bind(gl::kStripsUnit);
  joints_on_gpu_.bind(0);
  std::size_t first = 0;
  for (const meshes::DetailLevel& level : sorter_.levels()) {
    if (level.blades.empty()) continue;
    const GLint copies = level.is_far ? 1 : copies_;
    glUniform1i(copies_place, copies);
    glUniform1i(rings_place, static_cast<GLint>(level.rings));
    const auto ribbons = static_cast<std::size_t>(copies);
    strips_.draw(first_corner_place, 2 * (level.rings + 1), first * ribbons, level.blades.size() * ribbons);
    first += level.blades.size();
  }
}

}  // namespace yuragi::viewer::looks
