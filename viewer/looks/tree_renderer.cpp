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

meshes::SprayDetail detail_of(look::Quality quality) {
  switch (quality) {
    case look::Quality::kLow:
      return {.leaf_px = 7.0F, .largest = 5.0F, .shaped_leaf_px = 60.0F};
    case look::Quality::kMedium:
      return {.leaf_px = 5.5F, .largest = 4.0F, .shaped_leaf_px = 40.0F};
    case look::Quality::kHigh:
    case look::Quality::kAuto:
      break;
  }
  return {.leaf_px = 4.0F, .largest = 3.0F, .shaped_leaf_px = 30.0F};
}

/// Shadows are soft, and hide what a leaf is like.
meshes::SprayDetail shadow_detail_of(const meshes::SprayDetail& detail) {
  return {.leaf_px = 2.0F * detail.leaf_px, .largest = 1.3F * detail.largest, .shaped_leaf_px = 1e6F};
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

void enable_instances(GLuint attributes) {
  for (GLuint attribute = 0; attribute < attributes; ++attribute) {
    glEnableVertexAttribArray(attribute);
    glVertexAttribDivisor(attribute, 1);
  }
}

/// Lets the bound array read branches of the bound buffer from the `first` on.
void describe_parts(std::size_t first) {
  using Part = meshes::TreePart;
  const std::size_t begin = first * sizeof(Part);
  glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, sizeof(Part), offset_of(begin + offsetof(Part, root_m)));
  glVertexAttribPointer(1, 4, GL_FLOAT, GL_FALSE, sizeof(Part), offset_of(begin + offsetof(Part, tint)));
  glVertexAttribPointer(2, 3, GL_FLOAT, GL_FALSE, sizeof(Part), offset_of(begin + offsetof(Part, facing)));
  glVertexAttribIPointer(3, 1, GL_UNSIGNED_INT, sizeof(Part), offset_of(begin + offsetof(Part, strand)));
  glVertexAttribIPointer(4, 1, GL_INT, sizeof(Part), offset_of(begin + offsetof(Part, root_at)));
}

/// The same of sprays.
void describe_sprays(std::size_t first) {
  constexpr std::size_t kVectors = sizeof(meshes::SprayPlace) / sizeof(glm::vec4);
  for (GLuint vector = 0; vector < kVectors; ++vector) {
    glVertexAttribPointer(vector, 4, GL_FLOAT, GL_FALSE, sizeof(meshes::SprayPlace),
                          offset_of(first * sizeof(meshes::SprayPlace) + vector * sizeof(glm::vec4)));
  }
}
static_assert(sizeof(meshes::SprayPlace) == 6 * sizeof(glm::vec4));

meshes::Bounds crown_bounds(const pose::TreeSkeleton& tree) {
  for (const pose::TreeLevel& level : tree.levels) {
    if (!level.is_leaves) continue;
    pose::TreeSkeleton leaves;
    leaves.levels.push_back(level);
    return meshes::bounds_of(leaves);
  }
  return meshes::bounds_of(tree);
}

/// Where the trees of a skeleton stand: the streamed one.
std::vector<meshes::TreePlace> places_of(const pose::TreeSkeleton& tree) {
  meshes::TreePlace own;
  if (!tree.levels.empty() && tree.levels[0].strands.strand_count > 0) {
    const pose::StrandSkeleton& trunk = tree.levels[0].strands;
    own.from_m = own.to_m = glm::vec3(trunk.root_x_m[0], trunk.root_y_m[0], trunk.root_z_m[0]);
  }
  return {own};
}

void set_int(const gl::GlProgram& program, const char* name, std::size_t value) {
  glUniform1i(glGetUniformLocation(program.name(), name), static_cast<GLint>(value));
}

void set_vec3(const gl::GlProgram& program, const char* name, const glm::vec3& value) {
  glUniform3f(glGetUniformLocation(program.name(), name), value.x, value.y, value.z);
}

void set_place(const gl::GlProgram& program, const meshes::TreePlace& place) {
  set_vec3(program, "place_from_m", place.from_m);
  glUniform4f(glGetUniformLocation(program.name(), "place_to_m"), place.to_m.x, place.to_m.y, place.to_m.z,
              place.scale);
  glUniform2f(glGetUniformLocation(program.name(), "place_turn"), place.cosine, place.sine);
}

}  // namespace

TreeRenderer::TreeRenderer(const pose::TreeSkeleton& tree, look::Quality quality)
    : tree_(&tree),
      crown_bounds_(crown_bounds(tree)),
      places_(places_of(tree)),
      joints_(tree),
      detail_(detail_of(quality)),
      bark_(gl::link_program("bark", gl::shaders::kBarkVert, gl::shaders::kBarkFrag)),
      leaf_(gl::link_program("leaf", gl::shaders::kLeafVert, gl::shaders::kShadeFrag)),
      contact_(gl::link_program("contact", gl::shaders::kContactVert, gl::shaders::kContactFrag)) {
  for (std::size_t i = 0; i < tree.levels.size(); ++i) {
    if (tree.levels[i].is_leaves) {
      Foliage& foliage = *foliages_.emplace_back(std::make_unique<Foliage>(Foliage{.crown = meshes::Crown(tree, i)}));
      glBindBuffer(GL_ARRAY_BUFFER, foliage.place_buffer.name());
      make_spray(foliage.near_spray, meshes::near_spray(foliage.crown.shape()));
      make_spray(foliage.far_spray, meshes::far_spray(foliage.crown.shape()));
      continue;
    }
    Wood& wood = *woods_.emplace_back(
        std::make_unique<Wood>(Wood{.level = i, .sides = sides_of(i), .branches = meshes::Branches(tree, i)}));
    glBindVertexArray(wood.array.name());
    glBindBuffer(GL_ARRAY_BUFFER, wood.part_buffer.name());
    enable_instances(5);
    fill(GL_ELEMENT_ARRAY_BUFFER, wood.index_buffer,
         tube_triangles(tree.levels[i].strands.links_per_strand, wood.sides));
  }
  gl::set_sampler(bark_, "joints", 0);
  glBindBuffer(GL_TEXTURE_BUFFER, joint_buffer_.name());  // creates the buffer, even if no pose is ever taken
}

void TreeRenderer::make_spray(SprayOnGpu& spray, const meshes::SprayMesh& mesh) {
  using Corner = meshes::SprayCorner;
  glBindVertexArray(spray.array.name());
  enable_instances(6);
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
  for (const auto& foliage : foliages_) foliage->crown.move_to(joints_);

  // The wood's joints, level behind level, in a new buffer each time, since the GPU may still read the old one.
  glBindBuffer(GL_TEXTURE_BUFFER, joint_buffer_.name());
  const std::size_t count = meshes::first_joint_at(*tree_, tree_->levels.size());
  glBufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(count * sizeof(float)), nullptr, GL_STREAM_DRAW);
  for (const auto& wood : woods_) {
    wood->branches.move_to(joints_);
    const std::span<const float> joints = std::as_const(joints_).level(wood->level).data();
    glBufferSubData(GL_TEXTURE_BUFFER,
                    static_cast<GLintptr>(meshes::first_joint_at(*tree_, wood->level) * sizeof(float)),
                    static_cast<GLsizeiptr>(joints.size_bytes()), joints.data());
    gl::count_upload(joints.size_bytes());
  }
}

void TreeRenderer::draw(const meshes::View& view) {
  draw_all(view, detail_);
}

void TreeRenderer::draw_shadow(const meshes::View& view) {
  draw_all(view, shadow_detail_of(detail_));
}

void TreeRenderer::draw_all(const meshes::View& view, const meshes::SprayDetail& detail) {
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_BUFFER, joint_texture_.name());
  glTexBuffer(GL_TEXTURE_BUFFER, GL_R32F, joint_buffer_.name());
  for (const meshes::TreePlace& place : places_) {
    for (const auto& wood : woods_) draw_branches(*wood, view, place);
    for (const auto& foliage : foliages_) draw_sprays(*foliage, view, detail, place);
  }
}

void TreeRenderer::draw_light() {
  if (woods_.empty() || woods_[0]->level != 0) return;
  glEnable(GL_BLEND);
  glBlendFunc(GL_DST_COLOR, GL_ZERO);
  glDepthMask(GL_FALSE);
  glEnable(GL_POLYGON_OFFSET_FILL);  // in front of the ground
  glPolygonOffset(-2.0F, -2.0F);
  glUseProgram(contact_.name());
  for (const meshes::TreePlace& place : places_) {
    set_place(contact_, place);
    glUniform1f(glGetUniformLocation(contact_.name(), "radius_m"), tree_->levels[0].base_radius_m[0]);
    glBindVertexArray(woods_[0]->array.name());
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  }
  glDisable(GL_POLYGON_OFFSET_FILL);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

void TreeRenderer::draw_branches(Wood& wood, const meshes::View& view, const meshes::TreePlace& place) {
  wood.branches.choose(view, place);
  if (wood.branches.parts().empty()) return;
  glUseProgram(bark_.name());
  set_place(bark_, place);
  set_vec3(bark_, "crown_middle_m", place.moved((crown_bounds_.low_m + crown_bounds_.high_m) / 2.0F));
  set_vec3(bark_, "crown_radius_m", place.scale * (crown_bounds_.high_m - crown_bounds_.low_m) / 2.0F + 0.01F);
  set_int(bark_, "first", meshes::first_joint_at(*tree_, wood.level));
  set_int(bark_, "links", tree_->levels[wood.level].strands.links_per_strand);
  set_int(bark_, "sides", static_cast<std::size_t>(wood.sides));
  glBindVertexArray(wood.array.name());
  gl::stream_to(GL_ARRAY_BUFFER, wood.part_buffer, wood.branches.parts());
  for (const meshes::BranchGroup& group : wood.branches.groups()) {
    if (group.count == 0) continue;
    set_int(bark_, "rings", group.rings);
    describe_parts(group.first);
    glDrawElementsInstanced(GL_TRIANGLES, static_cast<GLsizei>(6 * group.rings) * wood.sides, GL_UNSIGNED_INT, nullptr,
                            static_cast<GLsizei>(group.count));
  }
}

void TreeRenderer::draw_sprays(Foliage& foliage, const meshes::View& view, const meshes::SprayDetail& detail,
                               const meshes::TreePlace& place) {
  foliage.crown.choose(view, detail, place);
  if (foliage.crown.places().empty()) return;
  glUseProgram(leaf_.name());
  set_int(leaf_, "kind", static_cast<std::size_t>(foliage.crown.shape().kind));
  gl::stream_to(GL_ARRAY_BUFFER, foliage.place_buffer, foliage.crown.places());
  for (const meshes::SprayGroup& group : foliage.crown.groups()) {
    if (group.count == 0) continue;
    const SprayOnGpu& spray = group.is_near ? foliage.near_spray : foliage.far_spray;
    glBindVertexArray(spray.array.name());
    describe_sprays(group.first);
    glDrawElementsInstanced(GL_TRIANGLES, static_cast<GLsizei>(spray.stalk_indices + group.leaves * spray.leaf_indices),
                            GL_UNSIGNED_INT, nullptr, static_cast<GLsizei>(group.count));
  }
}

}  // namespace yuragi::viewer::looks
