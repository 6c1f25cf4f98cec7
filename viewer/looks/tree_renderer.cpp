#include "viewer/looks/tree_renderer.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "viewer/gl/shaders.hpp"

namespace yuragi::viewer::looks {
namespace {

meshes::SprayDetail detail_of(look::Quality quality) {
  switch (quality) {
    case look::Quality::kLow:
      return {.leaf_px = 5.5F, .largest = 4.0F, .shaped_leaf_px = 60.0F, .speck_px = 6.0F, .hidden_share = 0.3F};
    case look::Quality::kMedium:
      return {.leaf_px = 4.5F, .largest = 3.5F, .shaped_leaf_px = 40.0F, .speck_px = 6.0F, .hidden_share = 0.4F};
    case look::Quality::kHigh:
    case look::Quality::kAuto:
      break;
  }
  return {.leaf_px = 3.5F, .largest = 3.0F, .shaped_leaf_px = 30.0F, .speck_px = 4.0F, .hidden_share = 0.5F};
}

/// A ring of a branch for so many pixels of its length.
float ring_px_of(look::Quality quality) {
  return quality == look::Quality::kLow ? 10.0F : 6.0F;
}

/// Shadows are soft, and hide what a leaf is like.
meshes::SprayDetail shadow_detail_of(const meshes::SprayDetail& detail) {
  return {.leaf_px = 2.0F * detail.leaf_px, .largest = 1.3F * detail.largest, .shaped_leaf_px = 1e6F, .speck_px = 1e6F};
}

/// The triangles of a tube; vertex (ring, side) is ring * (sides + 1) + side, the last side at the seam again.
std::vector<std::uint32_t> tube_triangles(std::size_t rings, std::size_t sides) {
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

/// Where the trees of a skeleton stand: the streamed one, and its copies.
std::vector<meshes::TreePlace> places_of(const pose::TreeSkeleton& tree) {
  meshes::TreePlace own;
  if (!tree.levels.empty() && tree.levels[0].strands.strand_count > 0) {
    const pose::StrandSkeleton& trunk = tree.levels[0].strands;
    own.from_m = own.to_m = glm::vec3(trunk.root_x_m[0], trunk.root_y_m[0], trunk.root_z_m[0]);
  }
  std::vector<meshes::TreePlace> places{own};
  for (std::size_t i = 0; i < tree.copies.x_m.size(); ++i) {
    places.push_back({.from_m = own.from_m,
                      .to_m = {tree.copies.x_m[i], own.from_m.y, tree.copies.z_m[i]},
                      .cosine = std::cos(tree.copies.turn_rad[i]),
                      .sine = std::sin(tree.copies.turn_rad[i]),
                      .scale = tree.copies.scale[i]});
  }
  return places;
}

bool fits(const pose::TreePose& pose, const pose::TreeSkeleton& tree) {
  return std::ranges::equal(pose.levels, tree.levels, [](const pose::StrandPose& bends, const pose::TreeLevel& level) {
    return bends.bend_east_rad.size() == level.strands.padded_count() &&
           bends.bend_south_rad.size() == level.strands.padded_count();
  });
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
      detail_(detail_of(quality)),
      ring_px_(ring_px_of(quality)),
      bark_(gl::link_program("bark", gl::shaders::kBarkVert, gl::shaders::kBarkFrag)),
      leaf_(gl::link_program("leaf", gl::shaders::kLeafVert, gl::shaders::kShadeFrag)),
      contact_(gl::link_program("contact", gl::shaders::kContactVert, gl::shaders::kContactFrag)) {
  for (std::size_t i = 0; i < tree.levels.size(); ++i) {
    if (tree.levels[i].is_leaves) {
      Foliage& foliage = *foliages_.emplace_back(std::make_unique<Foliage>());
      foliage.level = i;
      foliage.shape = meshes::spray_shape(tree);
      make_spray(foliage.sprays.at(static_cast<std::size_t>(meshes::SprayKind::kSpeck)),
                 meshes::speck_spray(foliage.shape));
      make_spray(foliage.sprays.at(static_cast<std::size_t>(meshes::SprayKind::kFar)),
                 meshes::far_spray(foliage.shape));
      make_spray(foliage.sprays.at(static_cast<std::size_t>(meshes::SprayKind::kNear)),
                 meshes::near_spray(foliage.shape));
      continue;
    }
    Wood& wood = *woods_.emplace_back(std::make_unique<Wood>());
    wood.level = i;
    glBindVertexArray(wood.array.name());
    glBindBuffer(GL_ARRAY_BUFFER, wood.part_buffer.name());
    enable_instances(5);
    for (std::size_t tube = 0; tube < wood.tubes.size(); ++tube) {
      fill(GL_ELEMENT_ARRAY_BUFFER, wood.tubes.at(tube),
           tube_triangles(tree.levels[i].strands.links_per_strand, meshes::Branches::kSides.at(tube)));
    }
  }
  gl::set_sampler(bark_, "joints", 0);
  for (const meshes::TreePlace& place : places_of(tree)) add_place(place);
}

void TreeRenderer::add_place(const meshes::TreePlace& place) {
  constexpr float kAlike = 1e-4F;
  const auto is_alike = [&](const std::unique_ptr<Alike>& alike) {
    return std::abs(alike->cosine - place.cosine) < kAlike && std::abs(alike->sine - place.sine) < kAlike;
  };
  const auto same = std::find_if(trees_.begin(), trees_.end(), is_alike);
  if (same != trees_.end()) {
    (*same)->places.push_back(place);
    return;
  }
  Alike& alike = *trees_.emplace_back(std::make_unique<Alike>(Alike{.cosine = place.cosine,
                                                                    .sine = place.sine,
                                                                    .places = {place},
                                                                    .bends = {},
                                                                    .joints = pose::TreeJoints(*tree_),
                                                                    .branches = {},
                                                                    .crowns = {}}));
  for (const pose::TreeLevel& level : tree_->levels) {
    const std::vector<float> rest(level.strands.padded_count(), 0.0F);
    alike.bends.levels.push_back({.bend_east_rad = rest, .bend_south_rad = rest});
  }
  const Alike& first = *trees_.front();
  for (std::size_t i = 0; i < woods_.size(); ++i) {
    alike.branches.push_back(&first == &alike ? meshes::Branches(*tree_, woods_[i]->level) : first.branches[i]);
  }
  for (std::size_t i = 0; i < foliages_.size(); ++i) {
    alike.crowns.push_back(&first == &alike ? meshes::Crown(*tree_, foliages_[i]->level) : first.crowns[i]);
  }
  glBindBuffer(GL_TEXTURE_BUFFER, alike.joint_buffer.name());  // creates the buffer, even if no pose is ever taken
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
  if (bends == nullptr || !fits(*bends, *tree_)) return;
  for (const auto& alike : trees_) move(*alike, *bends);
}

void TreeRenderer::move(Alike& alike, const pose::TreePose& bends) {
  // The tree is turned after it is bent: so that it bends to where the wind goes, bends are turned back before.
  for (std::size_t level = 0; level < bends.levels.size(); ++level) {
    const pose::StrandPose& from = bends.levels[level];
    pose::StrandPose& to = alike.bends.levels[level];
    for (std::size_t i = 0; i < from.bend_east_rad.size(); ++i) {
      to.bend_east_rad[i] = alike.cosine * from.bend_east_rad[i] + alike.sine * from.bend_south_rad[i];
      to.bend_south_rad[i] = alike.cosine * from.bend_south_rad[i] - alike.sine * from.bend_east_rad[i];
    }
  }
  const pose::TreeKinematicsJob job{.skeleton = tree_, .pose = &alike.bends, .row = {}, .joints = &alike.joints};
  if (job.run() != pose::TreeKinematicsJob::Problem::kNone) return;
  for (meshes::Crown& crown : alike.crowns) crown.move_to(alike.joints);
  for (meshes::Branches& branches : alike.branches) branches.move_to(alike.joints);

  // The wood's joints, level behind level, in a new buffer each time, since the GPU may still read the old one.
  glBindBuffer(GL_TEXTURE_BUFFER, alike.joint_buffer.name());
  const std::size_t count = meshes::first_joint_at(*tree_, tree_->levels.size());
  glBufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(count * sizeof(float)), nullptr, GL_STREAM_DRAW);
  for (const auto& wood : woods_) {
    const std::span<const float> joints = std::as_const(alike.joints).level(wood->level).data();
    glBufferSubData(GL_TEXTURE_BUFFER,
                    static_cast<GLintptr>(meshes::first_joint_at(*tree_, wood->level) * sizeof(float)),
                    static_cast<GLsizeiptr>(joints.size_bytes()), joints.data());
    gl::count_upload(joints.size_bytes());
  }
}

void TreeRenderer::draw(const meshes::View& view) {
  draw_all(view, detail_, ring_px_);
}

void TreeRenderer::draw_shadow(const meshes::View& view) {
  draw_all(view, shadow_detail_of(detail_), 2.0F * ring_px_);
}

void TreeRenderer::draw_all(const meshes::View& view, const meshes::SprayDetail& detail, float ring_px) {
  glActiveTexture(GL_TEXTURE0);
  for (const auto& alike : trees_) {
    glBindTexture(GL_TEXTURE_BUFFER, alike->joint_texture.name());
    glTexBuffer(GL_TEXTURE_BUFFER, GL_R32F, alike->joint_buffer.name());
    for (const meshes::TreePlace& place : alike->places) {
      for (std::size_t i = 0; i < woods_.size(); ++i) {
        alike->branches[i].choose(view, ring_px, place);
        draw_branches(*woods_[i], alike->branches[i], place);
      }
      for (std::size_t i = 0; i < foliages_.size(); ++i) {
        alike->crowns[i].choose(view, detail, place);
        draw_sprays(*foliages_[i], alike->crowns[i]);
      }
    }
  }
}

void TreeRenderer::draw_light() {
  if (woods_.empty() || woods_[0]->level != 0 || tree_->levels[0].strands.strand_count == 0) return;
  glEnable(GL_BLEND);
  glBlendFunc(GL_DST_COLOR, GL_ZERO);
  glDepthMask(GL_FALSE);
  glEnable(GL_POLYGON_OFFSET_FILL);  // in front of the ground
  glPolygonOffset(-2.0F, -2.0F);
  glUseProgram(contact_.name());
  glUniform1f(glGetUniformLocation(contact_.name(), "radius_m"), tree_->levels[0].base_radius_m[0]);
  glBindVertexArray(woods_[0]->array.name());
  for (const auto& alike : trees_) {
    for (const meshes::TreePlace& place : alike->places) {
      set_place(contact_, place);
      glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    }
  }
  glDisable(GL_POLYGON_OFFSET_FILL);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

void TreeRenderer::draw_branches(const Wood& wood, const meshes::Branches& branches, const meshes::TreePlace& place) {
  if (branches.parts().empty()) return;
  glUseProgram(bark_.name());
  set_place(bark_, place);
  set_vec3(bark_, "crown_middle_m", place.moved((crown_bounds_.low_m + crown_bounds_.high_m) / 2.0F));
  set_vec3(bark_, "crown_radius_m", place.scale * (crown_bounds_.high_m - crown_bounds_.low_m) / 2.0F + 0.01F);
  set_int(bark_, "first", meshes::first_joint_at(*tree_, wood.level));
  set_int(bark_, "links", tree_->levels[wood.level].strands.links_per_strand);
  glBindVertexArray(wood.array.name());
  gl::stream_to(GL_ARRAY_BUFFER, wood.part_buffer, branches.parts());
  for (const meshes::BranchGroup& group : branches.groups()) {
    if (group.count == 0) continue;
    const std::size_t sides = meshes::Branches::kSides.at(group.tube);
    set_int(bark_, "rings", group.rings);
    set_int(bark_, "sides", sides);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, wood.tubes.at(group.tube).name());
    describe_parts(group.first);
    glDrawElementsInstanced(GL_TRIANGLES, static_cast<GLsizei>(6 * group.rings * sides), GL_UNSIGNED_INT, nullptr,
                            static_cast<GLsizei>(group.count));
  }
}

void TreeRenderer::draw_sprays(const Foliage& foliage, const meshes::Crown& crown) {
  if (crown.places().empty()) return;
  glUseProgram(leaf_.name());
  set_int(leaf_, "kind", static_cast<std::size_t>(foliage.shape.kind));
  glUniform1f(glGetUniformLocation(leaf_.name(), "silver"), foliage.shape.silver);
  gl::stream_to(GL_ARRAY_BUFFER, foliage.place_buffer, crown.places());
  for (const meshes::SprayGroup& group : crown.groups()) {
    if (group.count == 0) continue;
    const SprayOnGpu& spray = foliage.sprays.at(static_cast<std::size_t>(group.kind));
    glBindVertexArray(spray.array.name());
    describe_sprays(group.first);
    glDrawElementsInstanced(GL_TRIANGLES, static_cast<GLsizei>(spray.stalk_indices + group.leaves * spray.leaf_indices),
                            GL_UNSIGNED_INT, nullptr, static_cast<GLsizei>(group.count));
  }
}

}  // namespace yuragi::viewer::looks
