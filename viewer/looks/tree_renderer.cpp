#include "viewer/looks/tree_renderer.hpp"

#include <algorithm>
#include <cstddef>

#include "viewer/gl/shaders.hpp"

namespace yuragi::viewer::looks {
namespace {

/// Sides of a branch's tube, by level: the trunk is thick, twigs are thin.
GLsizei sides_of(std::size_t level) {
  return level == 0 ? 14 : (level == 1 ? 8 : 5);
}

/// The triangles of a tube; vertex (ring, side) is ring * (sides + 1) + side, the last side at the seam again.
std::vector<std::uint32_t> tube_triangles(std::size_t rings, GLsizei sides) {
  std::vector<std::uint32_t> indices;
  const auto across = static_cast<std::uint32_t>(sides);
  for (std::uint32_t ring = 0; ring < rings; ++ring) {
    for (std::uint32_t side = 0; side < across; ++side) {
      const std::uint32_t here = ring * (across + 1) + side;
      const std::uint32_t above = here + across + 1;
      indices.insert(indices.end(), {here, here + 1, above, above, here + 1, above + 1});
    }
  }
  return indices;
}

void describe_part(const gl::GlVertexArray& array, const gl::GlBuffer& buffer,
                   const std::vector<meshes::TreePart>& parts) {
  // OpenGL takes an offset in a buffer as a pointer.
  // NOLINTNEXTLINE(performance-no-int-to-ptr)
  const auto at = [](std::size_t offset) { return reinterpret_cast<const void*>(offset); };
  glBindVertexArray(array.name());
  glBindBuffer(GL_ARRAY_BUFFER, buffer.name());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(parts.size() * sizeof(meshes::TreePart)), parts.data(),
               GL_STATIC_DRAW);
  glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, sizeof(meshes::TreePart), at(offsetof(meshes::TreePart, root_m)));
  glVertexAttribPointer(1, 4, GL_FLOAT, GL_FALSE, sizeof(meshes::TreePart), at(offsetof(meshes::TreePart, tint)));
  glVertexAttribPointer(2, 3, GL_FLOAT, GL_FALSE, sizeof(meshes::TreePart), at(offsetof(meshes::TreePart, facing)));
  glVertexAttribIPointer(3, 1, GL_UNSIGNED_INT, sizeof(meshes::TreePart), at(offsetof(meshes::TreePart, strand)));
  glVertexAttribIPointer(4, 1, GL_INT, sizeof(meshes::TreePart), at(offsetof(meshes::TreePart, root_at)));
  glVertexAttribPointer(5, 3, GL_FLOAT, GL_FALSE, sizeof(meshes::TreePart), at(offsetof(meshes::TreePart, rest)));
  for (GLuint attribute = 0; attribute < 6; ++attribute) {
    glEnableVertexAttribArray(attribute);
    glVertexAttribDivisor(attribute, 1);
  }
}

/// Sets a program's uniforms of the crown: the box around the leaves, or around all where there are none.
void set_crown(const gl::GlProgram& program, const pose::TreeSkeleton& tree, const meshes::Bounds& all) {
  meshes::Bounds crown = all;
  for (std::size_t level = 0; level < tree.levels.size(); ++level) {
    if (!tree.levels[level].is_leaves) continue;
    pose::TreeSkeleton leaves;
    leaves.levels.push_back(tree.levels[level]);
    crown = meshes::bounds_of(leaves);
  }
  const glm::vec3 middle = (crown.low_m + crown.high_m) / 2.0F;
  const glm::vec3 radius = (crown.high_m - crown.low_m) / 2.0F + 0.01F;
  glUseProgram(program.name());
  glUniform3f(glGetUniformLocation(program.name(), "crown_middle_m"), middle.x, middle.y, middle.z);
  glUniform3f(glGetUniformLocation(program.name(), "crown_radius_m"), radius.x, radius.y, radius.z);
}

void set_int(const gl::GlProgram& program, const char* name, std::size_t value) {
  glUniform1i(glGetUniformLocation(program.name(), name), static_cast<GLint>(value));
}

}  // namespace

TreeRenderer::TreeRenderer(const pose::TreeSkeleton& tree)
    : tree_(&tree),
      bounds_(meshes::bounds_of(tree)),
      joints_(tree),
      levels_(tree.levels.size()),
      bark_(gl::link_program("bark", gl::shaders::kBarkVert, gl::shaders::kBarkFrag)),
      leaf_(gl::link_program("leaf", gl::shaders::kLeafVert, gl::shaders::kShadeFrag)) {
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    Level& level = levels_[i];
    describe_part(level.array, level.part_buffer, meshes::tree_parts(tree, i));
    if (tree.levels[i].is_leaves) continue;
    level.sides = sides_of(i);
    const std::vector<std::uint32_t> triangles = tube_triangles(tree.levels[i].strands.links_per_strand, level.sides);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, level.index_buffer.name());
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(triangles.size() * sizeof(std::uint32_t)),
                 triangles.data(), GL_STATIC_DRAW);
  }
  for (const gl::GlProgram* program : {&bark_, &leaf_}) {
    gl::set_sampler(*program, "joints", 0);
    set_crown(*program, tree, bounds_);
  }
  glBindBuffer(GL_TEXTURE_BUFFER, joint_buffer_.name());  // creates the buffer, even if no pose is ever taken
}

void TreeRenderer::move_to(const pose::Pose& pose) {
  const auto* const bends = std::get_if<pose::TreePose>(&pose);
  const pose::TreeKinematicsJob job{.skeleton = tree_, .pose = bends, .row = {}, .joints = &joints_};
  if (job.run() != pose::TreeKinematicsJob::Problem::kNone) return;

  // Level behind level, in a new buffer each time, since the GPU may still read the old one.
  glBindBuffer(GL_TEXTURE_BUFFER, joint_buffer_.name());
  const std::size_t count = meshes::first_joint_at(*tree_, levels_.size());
  glBufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(count * sizeof(float)), nullptr, GL_STREAM_DRAW);
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    const std::span<const float> joints = std::as_const(joints_).level(i).data();
    glBufferSubData(GL_TEXTURE_BUFFER, static_cast<GLintptr>(meshes::first_joint_at(*tree_, i) * sizeof(float)),
                    static_cast<GLsizeiptr>(joints.size_bytes()), joints.data());
    gl::count_upload(joints.size_bytes());
  }
}

void TreeRenderer::draw(const meshes::View& view) {
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_BUFFER, joint_texture_.name());
  glTexBuffer(GL_TEXTURE_BUFFER, GL_R32F, joint_buffer_.name());
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    if (tree_->levels[i].is_leaves) {
      draw_leaves(i);
    } else {
      draw_branches(i, meshes::tree_rings(tree_->levels[i], bounds_, view));
    }
  }
}

void TreeRenderer::draw_branches(std::size_t level, std::size_t rings) {
  const pose::StrandSkeleton& strands = tree_->levels[level].strands;
  glUseProgram(bark_.name());
  set_int(bark_, "first", meshes::first_joint_at(*tree_, level));
  set_int(bark_, "links", strands.links_per_strand);
  set_int(bark_, "rings", rings);
  set_int(bark_, "sides", static_cast<std::size_t>(levels_[level].sides));
  glBindVertexArray(levels_[level].array.name());
  const auto indices = static_cast<GLsizei>(6 * rings) * levels_[level].sides;
  glDrawElementsInstanced(GL_TRIANGLES, indices, GL_UNSIGNED_INT, nullptr, static_cast<GLsizei>(strands.strand_count));
}

void TreeRenderer::draw_leaves(std::size_t level) {
  const pose::StrandSkeleton& strands = tree_->levels[level].strands;
  glUseProgram(leaf_.name());
  set_int(leaf_, "first", meshes::first_joint_at(*tree_, level));
  set_int(leaf_, "links", strands.links_per_strand);
  glBindVertexArray(levels_[level].array.name());
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, static_cast<GLsizei>(2 * (strands.links_per_strand + 1)),
                        static_cast<GLsizei>(strands.strand_count));
}

}  // namespace yuragi::viewer::looks
