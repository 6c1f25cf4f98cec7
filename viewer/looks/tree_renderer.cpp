#include "viewer/looks/tree_renderer.hpp"

#include <algorithm>
#include <cmath>
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

/// OpenGL takes an offset in a buffer as a pointer.
const void* offset_of(std::size_t offset) {
  return reinterpret_cast<const void*>(offset);  // NOLINT(performance-no-int-to-ptr)
}

template <class T>
void fill(GLenum target, const gl::GlBuffer& buffer, const std::vector<T>& content) {
  glBindBuffer(target, buffer.name());
  glBufferData(target, static_cast<GLsizeiptr>(content.size() * sizeof(T)), content.data(), GL_STATIC_DRAW);
}

/// Lets the array read an instance of `buffer` for each strand.
void describe_parts(const gl::GlVertexArray& array, const gl::GlBuffer& buffer) {
  using Part = meshes::TreePart;
  glBindVertexArray(array.name());
  glBindBuffer(GL_ARRAY_BUFFER, buffer.name());
  glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, sizeof(Part), offset_of(offsetof(Part, root_m)));
  glVertexAttribPointer(1, 4, GL_FLOAT, GL_FALSE, sizeof(Part), offset_of(offsetof(Part, tint)));
  glVertexAttribPointer(2, 3, GL_FLOAT, GL_FALSE, sizeof(Part), offset_of(offsetof(Part, facing)));
  glVertexAttribIPointer(3, 1, GL_UNSIGNED_INT, sizeof(Part), offset_of(offsetof(Part, strand)));
  glVertexAttribIPointer(4, 1, GL_INT, sizeof(Part), offset_of(offsetof(Part, root_at)));
  glVertexAttribPointer(5, 3, GL_FLOAT, GL_FALSE, sizeof(Part), offset_of(offsetof(Part, rest)));
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
      spray_shape_(meshes::spray_shape(tree)),
      bark_(gl::link_program("bark", gl::shaders::kBarkVert, gl::shaders::kBarkFrag)),
      leaf_(gl::link_program("leaf", gl::shaders::kLeafVert, gl::shaders::kShadeFrag)),
      contact_(gl::link_program("contact", gl::shaders::kContactVert, gl::shaders::kContactFrag)) {
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    Level& level = levels_[i];
    fill(GL_ARRAY_BUFFER, level.part_buffer, meshes::tree_parts(tree, i));
    if (tree.levels[i].is_leaves) {
      level.spray_length_m = meshes::mean_length_m(tree.levels[i].strands);
      make_spray(level.near_spray, meshes::near_spray(spray_shape_), level.part_buffer);
      make_spray(level.far_spray, meshes::far_spray(spray_shape_), level.part_buffer);
      continue;
    }
    describe_parts(level.array, level.part_buffer);
    level.sides = sides_of(i);
    fill(GL_ELEMENT_ARRAY_BUFFER, level.index_buffer,
         tube_triangles(tree.levels[i].strands.links_per_strand, level.sides));
  }
  for (const gl::GlProgram* program : {&bark_, &leaf_}) {
    gl::set_sampler(*program, "joints", 0);
    set_crown(*program, tree, bounds_);
  }
  glBindBuffer(GL_TEXTURE_BUFFER, joint_buffer_.name());  // creates the buffer, even if no pose is ever taken
}

void TreeRenderer::make_spray(Spray& spray, const meshes::SprayMesh& mesh, const gl::GlBuffer& part_buffer) {
  using Corner = meshes::SprayCorner;
  describe_parts(spray.array, part_buffer);
  fill(GL_ARRAY_BUFFER, spray.corner_buffer, mesh.corners);
  glVertexAttribPointer(6, 4, GL_FLOAT, GL_FALSE, sizeof(Corner), offset_of(offsetof(Corner, at)));
  glVertexAttribPointer(7, 2, GL_FLOAT, GL_FALSE, sizeof(Corner), offset_of(offsetof(Corner, edge)));
  glEnableVertexAttribArray(6);
  glEnableVertexAttribArray(7);
  fill(GL_ELEMENT_ARRAY_BUFFER, spray.index_buffer, mesh.triangles);
  spray.stalk_indices = mesh.stalk_indices;
  spray.leaf_indices = mesh.leaf_indices;
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
      draw_sprays(i, view);
    } else {
      draw_branches(i, meshes::tree_rings(tree_->levels[i], bounds_, view));
    }
  }
}

void TreeRenderer::draw_light() {
  if (levels_.empty() || tree_->levels[0].is_leaves) return;
  glEnable(GL_BLEND);
  glBlendFunc(GL_DST_COLOR, GL_ZERO);
  glDepthMask(GL_FALSE);
  glEnable(GL_POLYGON_OFFSET_FILL);  // in front of the ground
  glPolygonOffset(-2.0F, -2.0F);
  glUseProgram(contact_.name());
  glBindVertexArray(levels_[0].array.name());
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(tree_->levels[0].strands.strand_count));
  glDisable(GL_POLYGON_OFFSET_FILL);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
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

void TreeRenderer::draw_sprays(std::size_t level, const meshes::View& view) {
  const pose::StrandSkeleton& strands = tree_->levels[level].strands;
  const meshes::SprayLevel detail = meshes::spray_level(spray_shape_, levels_[level].spray_length_m, bounds_, view);
  const Spray& spray = detail.is_near ? levels_[level].near_spray : levels_[level].far_spray;
  glUseProgram(leaf_.name());
  set_int(leaf_, "first", meshes::first_joint_at(*tree_, level));
  set_int(leaf_, "links", strands.links_per_strand);
  set_int(leaf_, "has_flowers", spray_shape_.has_flowers ? 1 : 0);
  glUniform1f(glGetUniformLocation(leaf_.name(), "leaves_drawn"), detail.leaves);
  glUniform1f(glGetUniformLocation(leaf_.name(), "leaf_size"), detail.size);
  glBindVertexArray(spray.array.name());
  const auto leaves = static_cast<std::size_t>(std::ceil(detail.leaves));
  glDrawElementsInstanced(GL_TRIANGLES, static_cast<GLsizei>(spray.stalk_indices + leaves * spray.leaf_indices),
                          GL_UNSIGNED_INT, nullptr, static_cast<GLsizei>(strands.strand_count));
}

}  // namespace yuragi::viewer::looks
