#include "viewer/looks/tree_renderer.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "viewer/gl/shaders.hpp"

namespace yuragi::viewer::looks {
namespace {

meshes::trees::SprayDetail detail_of(look::Quality quality) {
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

/// Length of a branch's ring in pixels.
float ring_px_of(look::Quality quality) {
  return quality == look::Quality::kLow ? 10.0F : 6.0F;
}

/// Trees up to this height in the picture, in pixels, and relative to their distance, are impostors: nobody looks at
/// one that far away.
float impostor_px_of(look::Quality quality) {
  return quality == look::Quality::kLow ? 240.0F : 160.0F;
}
constexpr float kImpostorHeight = 0.3F;

/// For the pictures of impostors.
constexpr meshes::trees::SprayDetail kPictureDetail{
    .leaf_px = 3.0F, .largest = 3.0F, .shaped_leaf_px = 1e6F, .speck_px = 4.0F, .hidden_share = 0.4F};
constexpr float kPictureRing_px = 12.0F;
constexpr float kPictureTwig_px = 0.04F;  // so thin that they cover the same area as near by

/// Shadows are soft, and hide the shape of a leaf.
meshes::trees::SprayDetail shadow_detail_of(const meshes::trees::SprayDetail& detail) {
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
void fill(GLenum target, const gl::Buffer& buffer, const std::vector<T>& content) {
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
  using Part = meshes::trees::Part;
  const std::size_t begin = first * sizeof(Part);
  glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, sizeof(Part), offset_of(begin + offsetof(Part, root_m)));
  glVertexAttribPointer(1, 4, GL_FLOAT, GL_FALSE, sizeof(Part), offset_of(begin + offsetof(Part, tint)));
  glVertexAttribPointer(2, 3, GL_FLOAT, GL_FALSE, sizeof(Part), offset_of(begin + offsetof(Part, facing)));
  glVertexAttribIPointer(3, 1, GL_UNSIGNED_INT, sizeof(Part), offset_of(begin + offsetof(Part, strand)));
  glVertexAttribIPointer(4, 1, GL_INT, sizeof(Part), offset_of(begin + offsetof(Part, root_at)));
  glVertexAttribPointer(5, 3, GL_FLOAT, GL_FALSE, sizeof(Part), offset_of(begin + offsetof(Part, rest)));
}

/// The same of sprays.
void describe_sprays(std::size_t first) {
  constexpr std::size_t kVectors = sizeof(meshes::trees::SprayPlace) / sizeof(glm::vec4);
  for (GLuint vector = 0; vector < kVectors; ++vector) {
    glVertexAttribPointer(vector, 4, GL_FLOAT, GL_FALSE, sizeof(meshes::trees::SprayPlace),
                          offset_of(first * sizeof(meshes::trees::SprayPlace) + vector * sizeof(glm::vec4)));
  }
}
static_assert(sizeof(meshes::trees::SprayPlace) == 6 * sizeof(glm::vec4));

meshes::Bounds crown_bounds(const pose::TreeSkeleton& tree) {
  for (const pose::TreeLevel& level : tree.levels) {
    if (!level.is_leaves) continue;
    pose::TreeSkeleton leaves;
    leaves.levels.push_back(level);
    return meshes::bounds_of(leaves);
  }
  return meshes::bounds_of(tree);
}

/// Bounds of the streamed tree alone.
meshes::Bounds bounds_without_grove(const pose::TreeSkeleton& tree) {
  pose::TreeSkeleton alone;
  alone.levels = tree.levels;
  return meshes::bounds_of(alone);
}

/// The places of a skeleton's trees: the streamed one, and its copies.
std::vector<meshes::trees::Place> places_of(const pose::TreeSkeleton& tree) {
  meshes::trees::Place own;
  if (!tree.levels.empty() && tree.levels[0].strands.strand_count > 0) {
    const pose::StrandSkeleton& trunk = tree.levels[0].strands;
    own.from_m = own.to_m = glm::vec3(trunk.root_x_m[0], trunk.root_y_m[0], trunk.root_z_m[0]);
  }
  std::vector<meshes::trees::Place> places{own};
  for (std::size_t i = 0; i < tree.copies.x_m.size(); ++i) {
    places.push_back({.from_m = own.from_m,
                      .to_m = {tree.copies.x_m[i], own.from_m.y, tree.copies.z_m[i]},
                      .cosine = std::cos(tree.copies.turn_rad[i]),
                      .sine = std::sin(tree.copies.turn_rad[i]),
                      .scale = tree.copies.scale[i]});
  }
  return places;
}

/// Blossom and bare trees do not change with the season.
bool loses_leaves(const pose::TreeSkeleton& tree) {
  return tree.foliage == pose::FoliageColor::kGreen || tree.foliage == pose::FoliageColor::kAutumn;
}

/// Below this share of leaves one sees the twigs.
constexpr float kTwigsSeenBelow = 0.5F;

/// The share of a tree's leaves that hang when the mean of all trees is `leaves`: some trees lose them earlier. None at
/// 0, all at 1.
float hanging_of(float tree_chance, float leaves) {
  return std::pow(leaves, glm::mix(0.6F, 1.7F, tree_chance));
}

LeafColors colors_of(const pose::TreeSkeleton& tree) {
  LeafColors colors{.has_palette = tree.foliage == pose::FoliageColor::kGreen,
                    .turns_red = 0.2F,
                    .silver = meshes::trees::spray_shape(tree).silver};
  switch (meshes::trees::leaf_species(tree)) {
    case meshes::trees::LeafSpecies::kCherry:
      colors.turns_red = 1.0F;
      break;
    case meshes::trees::LeafSpecies::kZelkova:
      colors.turns_red = 0.7F;
      break;
    case meshes::trees::LeafSpecies::kPoplar:
      break;
  }
  return colors;
}

bool fits(const pose::TreePose& pose, const pose::TreeSkeleton& tree) {
  return std::ranges::equal(pose.levels, tree.levels, [](const pose::StrandPose& bends, const pose::TreeLevel& level) {
    return bends.bend_east_rad.size() == level.strands.padded_count() &&
           bends.bend_south_rad.size() == level.strands.padded_count();
  });
}

void set_int(const gl::Program& program, const char* name, std::size_t value) {
  glUniform1i(glGetUniformLocation(program.name(), name), static_cast<GLint>(value));
}

void set_vec3(const gl::Program& program, const char* name, const glm::vec3& value) {
  glUniform3f(glGetUniformLocation(program.name(), name), value.x, value.y, value.z);
}

void set_place(const gl::Program& program, const meshes::trees::Place& place) {
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
      impostor_px_(impostor_px_of(quality)),
      colors_(colors_of(tree)),
      bark_(gl::link_program("bark", gl::shaders::kBarkVert, gl::shaders::kBarkFrag)),
      leaf_(quality == look::Quality::kLow
                ? gl::link_program("plain leaf", gl::shaders::kPlainLeafVert, gl::shaders::kShadeFrag)
                : gl::link_program("leaf", gl::shaders::kLeafVert, gl::shaders::kShadeFrag)),
      bark_shade_(gl::link_program("bark's shadow", gl::shaders::kBarkVert, gl::shaders::kDimFrag)),
      leaf_shade_(gl::link_program("leaf's shadow", gl::shaders::kLeafShadeVert, gl::shaders::kShadeFrag)),
      contact_(gl::link_program("contact", gl::shaders::kContactVert, gl::shaders::kContactFrag)) {
  for (std::size_t i = 0; i < tree.levels.size(); ++i) {
    if (tree.levels[i].is_leaves) {
      add_foliage(i, tree.foliage);
      if (loses_leaves(tree)) add_foliage(i, pose::FoliageColor::kBare);
      continue;
    }
    Wood& wood = *woods_.emplace_back(std::make_unique<Wood>());
    wood.level = i;
    wood.bare = meshes::trees::bare_share(tree, i);
    glBindVertexArray(wood.array.name());
    glBindBuffer(GL_ARRAY_BUFFER, wood.part_buffer.name());
    enable_instances(6);
    for (std::size_t tube = 0; tube < wood.tubes.size(); ++tube) {
      fill(GL_ELEMENT_ARRAY_BUFFER, wood.tubes.at(tube),
           tube_triangles(tree.levels[i].strands.links_per_strand, meshes::trees::Branches::kSides.at(tube)));
    }
  }
  for (const gl::Program* bark : {&bark_, &bark_shade_}) gl::set_sampler(*bark, "joints", 0);
  for (const meshes::trees::Place& place : places_of(tree)) add_place(place);
  box_ = meshes::trees::impostor_box(bounds_without_grove(tree));
  far_trees_.reserve(1 + tree.copies.x_m.size());
  if (woods_.empty()) impostor_px_ = 0.0F;
  move(*trees_.front(), moment_.hanging_leaves);
  middle_at_rest_m_ = middle_m(*trees_.front());
}

void TreeRenderer::add_foliage(std::size_t level, pose::FoliageColor color) {
  Foliage& foliage = *foliages_.emplace_back(std::make_unique<Foliage>());
  foliage.level = level;
  foliage.color = color;
  foliage.shape = meshes::trees::spray_shape(*tree_, color);
  make_spray(foliage.sprays.at(static_cast<std::size_t>(meshes::trees::SprayKind::kSpeck)),
             meshes::trees::speck_spray(foliage.shape));
  make_spray(foliage.sprays.at(static_cast<std::size_t>(meshes::trees::SprayKind::kFar)),
             meshes::trees::far_spray(foliage.shape));
  make_spray(foliage.sprays.at(static_cast<std::size_t>(meshes::trees::SprayKind::kNear)),
             meshes::trees::near_spray(foliage.shape));
}

/// The visible share of a foliage when this share of the leaves hangs: leaves, while there are any, twigs when few are
/// left. Blossom, and a tree that was bare before, do not change.
float TreeRenderer::shown_share(const Foliage& foliage, float hanging) const {
  if (!loses_leaves(*tree_)) return 1.0F;
  return foliage.color == tree_->foliage ? hanging : 1.0F - glm::smoothstep(0.0F, kTwigsSeenBelow, hanging);
}

void TreeRenderer::add_place(const meshes::trees::Place& place) {
  constexpr float kAlike = 1e-4F;
  const auto is_alike = [&](const std::unique_ptr<Alike>& alike) {
    return std::abs(alike->cosine - place.cosine) < kAlike && std::abs(alike->sine - place.sine) < kAlike;
  };
  const auto same = std::find_if(trees_.begin(), trees_.end(), is_alike);
  if (same != trees_.end()) {
    (*same)->places.push_back(place);
    return;
  }
  trees_.push_back(tree_at(place));
}

/// A tree at rest.
std::unique_ptr<TreeRenderer::Alike> TreeRenderer::tree_at(const meshes::trees::Place& place) const {
  auto tree = std::make_unique<Alike>(Alike{.cosine = place.cosine,
                                            .sine = place.sine,
                                            .places = {place},
                                            .bends = {},
                                            .joints = pose::TreeJoints(*tree_),
                                            .branches = {},
                                            .crowns = {}});
  for (const pose::TreeLevel& level : tree_->levels) {
    const std::vector<float> rest(level.strands.padded_count(), 0.0F);
    tree->bends.levels.push_back({.bend_east_rad = rest, .bend_south_rad = rest});
  }
  const Alike* const first = trees_.empty() ? nullptr : trees_.front().get();
  for (std::size_t i = 0; i < woods_.size(); ++i) {
    tree->branches.push_back(first == nullptr ? meshes::trees::Branches(*tree_, woods_[i]->level) : first->branches[i]);
  }
  for (std::size_t i = 0; i < foliages_.size(); ++i) {
    tree->crowns.push_back(first == nullptr ? meshes::trees::Crown(*tree_, foliages_[i]->level, foliages_[i]->color)
                                            : first->crowns[i]);
  }
  return tree;
}

void TreeRenderer::make_spray(SprayOnGpu& spray, const meshes::trees::SprayMesh& mesh) {
  using Corner = meshes::trees::SprayCorner;
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
  for (const auto& alike : trees_) turn_back(*alike, *bends);
  move(*trees_.front(), moment_.hanging_leaves);
  const glm::vec3 sway_m = middle_m(*trees_.front()) - middle_at_rest_m_;
  sway_.add(moment_.time_s, {sway_m.x, sway_m.z}, moment_.wind_m_s);
}

void TreeRenderer::turn_back(Alike& alike, const pose::TreePose& bends) {
  // The tree is turned after it is bent: the bends are first turned back, so that it bends in the wind's direction.
  for (std::size_t level = 0; level < bends.levels.size(); ++level) {
    const pose::StrandPose& from = bends.levels[level];
    pose::StrandPose& to = alike.bends.levels[level];
    for (std::size_t i = 0; i < from.bend_east_rad.size(); ++i) {
      to.bend_east_rad[i] = alike.cosine * from.bend_east_rad[i] + alike.sine * from.bend_south_rad[i];
      to.bend_south_rad[i] = alike.cosine * from.bend_south_rad[i] - alike.sine * from.bend_east_rad[i];
    }
  }
  alike.is_moved = false;
}

/// The middle of the tips of the thinnest wood.
glm::vec3 TreeRenderer::middle_m(const Alike& alike) const {
  if (woods_.empty()) return glm::vec3(0.0F);
  const std::size_t level = woods_.back()->level;
  const pose::StrandSkeleton& strands = tree_->levels[level].strands;
  glm::vec3 sum_m(0.0F);
  for (std::size_t i = 0; i < strands.strand_count; ++i) {
    const pose::JointPosition tip = std::as_const(alike.joints).level(level).joint(i, strands.links_per_strand - 1);
    sum_m += glm::vec3(tip.x_m, tip.y_m, tip.z_m);
  }
  return sum_m / static_cast<float>(std::max<std::size_t>(strands.strand_count, 1));
}

/// Applies the bends to its joints, and the visible share to its foliage.
void TreeRenderer::move(Alike& alike, float hanging_leaves) {
  alike.is_moved = true;
  const pose::TreeKinematicsJob job{.skeleton = tree_, .pose = &alike.bends, .row = {}, .joints = &alike.joints};
  if (job.run() != pose::TreeKinematicsJob::Problem::kNone) return;
  // No tree has fewer.
  const float fewest = hanging_of(1.0F, hanging_leaves);
  for (std::size_t i = 0; i < foliages_.size(); ++i) {
    if (shown_share(*foliages_[i], fewest) > 0.0F) alike.crowns[i].move_to(alike.joints);
  }
  for (meshes::trees::Branches& branches : alike.branches) branches.move_to(alike.joints);

  alike.joints_on_gpu.begin(meshes::trees::first_joint_at(*tree_, tree_->levels.size()));
  for (const auto& wood : woods_) {
    alike.joints_on_gpu.write(meshes::trees::first_joint_at(*tree_, wood->level),
                              std::span(std::as_const(alike.joints).level(wood->level).data()));
  }
}

float TreeRenderer::impostor_share(const meshes::View& view, const meshes::trees::Place& place) const {
  const float distance_m = std::max(glm::distance(glm::vec3(view.eye_m), place.moved(box_.middle_m)), 0.1F);
  const float height = place.scale * 2.0F * box_.half_height_m / distance_m;
  return std::min(meshes::trees::impostor_share(height / view.eye_m.w, impostor_px_),
                  meshes::trees::impostor_share(height, kImpostorHeight));
}

void TreeRenderer::prepare(const meshes::View& view, gl::ViewBuffer& views) {
  const bool is_far = std::ranges::any_of(trees_, [&](const auto& alike) {
    return std::ranges::any_of(alike->places, [&](const auto& place) { return impostor_share(view, place) > 0.0F; });
  });
  if (!is_far) return;
  if (!impostors_) impostors_ = pictures_of(views, 1.0F);
  const bool has_bare = loses_leaves(*tree_) && hanging_of(1.0F, moment_.hanging_leaves) < kTwigsSeenBelow;
  if (has_bare && !bare_impostors_) bare_impostors_ = pictures_of(views, 0.0F);
}

/// The pictures of the tree at rest with this foliage.
std::unique_ptr<TreeImpostors> TreeRenderer::pictures_of(gl::ViewBuffer& views, float hanging) {
  const gl::Program bark = gl::link_program("bark's picture", gl::shaders::kBarkVert, gl::shaders::kImpostorLookFrag);
  const gl::Program leaf = gl::link_program("leaf's picture", gl::shaders::kLeafVert, gl::shaders::kImpostorLookFrag);
  gl::set_sampler(bark, "joints", 0);
  const meshes::trees::Place& own = trees_.front()->places.front();
  const std::unique_ptr<Alike> at_rest = tree_at(own);
  move(*at_rest, hanging);
  const bool is_bare = foliages_.empty() || hanging == 0.0F;
  auto pictures = std::make_unique<TreeImpostors>(
      box_, own.from_m, is_bare ? meshes::trees::SprayShape::Kind::kTwigs : foliages_.front()->shape.kind, colors_);
  pictures->make(views, [&](const meshes::View& picture) {
    draw_tree({bark, leaf, {.silver = colors_.silver}, kPictureTwig_px}, picture, kPictureDetail, kPictureRing_px,
              *at_rest, own, hanging);
  });
  return pictures;
}

void TreeRenderer::draw(const meshes::View& view) {
  draw_all(view, detail_, ring_px_, false);
}

void TreeRenderer::draw_shadow(const meshes::View& view) {
  draw_all(view, shadow_detail_of(detail_), 2.0F * ring_px_, true);
}

void TreeRenderer::draw_all(const meshes::View& view, const meshes::trees::SprayDetail& detail, float ring_px,
                            bool is_shadow) {
  const Programs programs{is_shadow ? bark_shade_ : bark_, is_shadow ? leaf_shade_ : leaf_, colors_};
  const auto planes = side_planes(view);
  const float radius_m = std::hypot(box_.half_width_m, box_.half_height_m);
  // Gusts reach the tree that is farthest upwind first.
  const auto downwind_m = [&](const meshes::trees::Place& place) {
    return sway_.downwind_m({place.to_m.x - place.from_m.x, place.to_m.z - place.from_m.z});
  };
  float first_m = 0.0F;
  for (const auto& alike : trees_) {
    for (const meshes::trees::Place& place : alike->places) first_m = std::min(first_m, downwind_m(place));
  }
  far_trees_.clear();
  for (const auto& alike : trees_) {
    for (const meshes::trees::Place& place : alike->places) {
      const float share = impostors_ ? impostor_share(view, place) : 0.0F;
      const float hanging = loses_leaves(*tree_) ? hanging_of(place.chance(), moment_.hanging_leaves) : 1.0F;
      if (share < 1.0F) draw_tree(programs, view, detail, ring_px, *alike, place, hanging);
      const glm::vec4 middle_m(place.moved(box_.middle_m), 1.0F);
      const bool is_seen = std::all_of(planes.begin(), planes.end(), [&](const glm::vec4& plane) {
        return glm::dot(plane, middle_m) >= -1.2F * place.scale * radius_m;
      });
      if (share > 0.0F && is_seen) {
        const glm::vec2 sway_m = sway_.sway_m(sway_.delay_s(downwind_m(place) - first_m));
        far_trees_.push_back({.foot_scale = glm::vec4(place.to_m, place.scale),
                              .turn_sway = {place.cosine, place.sine, sway_m.x, sway_m.y},
                              .share = share,
                              .hanging = hanging,
                              .chance = place.chance()});
      }
    }
  }
  if (far_trees_.empty()) return;
  const float blown = foliages_.empty() ? 0.0F : trees_.front()->crowns.front().blown();
  if (moment_.hanging_leaves > 0.0F || !bare_impostors_) impostors_->draw(far_trees_, blown, is_shadow);
  if (!bare_impostors_) return;
  // Drawn behind the remaining leaves; not for trees with enough leaves.
  const auto& twigs = *foliages_.back();
  std::erase_if(far_trees_,
                [&](const meshes::trees::Impostor& tree) { return shown_share(twigs, tree.hanging) == 0.0F; });
  for (meshes::trees::Impostor& tree : far_trees_) tree.hanging = shown_share(twigs, tree.hanging);
  bare_impostors_->draw(far_trees_, 0.0F, is_shadow);
}

void TreeRenderer::draw_tree(const Programs& programs, const meshes::View& view,
                             const meshes::trees::SprayDetail& detail, float ring_px, Alike& alike,
                             const meshes::trees::Place& place, float hanging) {
  if (!alike.is_moved) move(alike, moment_.hanging_leaves);
  // The light in a tree that was bare before, or blossoms, does not change.
  const float leafy = loses_leaves(*tree_) ? hanging : 1.0F;
  alike.joints_on_gpu.bind(0);
  for (std::size_t i = 0; i < woods_.size(); ++i) {
    alike.branches[i].choose(view, ring_px, place);
    glUseProgram(programs.bark.name());
    glUniform1f(glGetUniformLocation(programs.bark.name(), "leafy"), leafy);
    draw_branches(programs.bark, *woods_[i], alike.branches[i], place);
  }
  for (std::size_t i = 0; i < foliages_.size(); ++i) {
    const float share = shown_share(*foliages_[i], hanging);
    if (share == 0.0F) continue;
    alike.crowns[i].choose(view, detail, place);
    glUseProgram(programs.leaf.name());
    programs.colors.set(programs.leaf);
    glUniform1f(glGetUniformLocation(programs.leaf.name(), "leafy"), leafy);
    glUniform1f(glGetUniformLocation(programs.leaf.name(), "thinnest_px"), programs.thinnest_px);
    glUniform1f(glGetUniformLocation(programs.leaf.name(), "hanging"), share);
    glUniform1f(glGetUniformLocation(programs.leaf.name(), "tree_chance"), place.chance());
    draw_sprays(programs.leaf, *foliages_[i], alike.crowns[i]);
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
    for (const meshes::trees::Place& place : alike->places) {
      set_place(contact_, place);
      glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    }
  }
  glDisable(GL_POLYGON_OFFSET_FILL);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

void TreeRenderer::draw_branches(const gl::Program& program, const Wood& wood, const meshes::trees::Branches& branches,
                                 const meshes::trees::Place& place) {
  if (branches.parts().empty()) return;
  glUseProgram(program.name());
  set_place(program, place);
  set_vec3(program, "crown_middle_m", place.moved((crown_bounds_.low_m + crown_bounds_.high_m) / 2.0F));
  set_vec3(program, "crown_radius_m", place.scale * (crown_bounds_.high_m - crown_bounds_.low_m) / 2.0F + 0.01F);
  set_int(program, "first", meshes::trees::first_joint_at(*tree_, wood.level));
  set_int(program, "links", tree_->levels[wood.level].strands.links_per_strand);
  glUniform1f(glGetUniformLocation(program.name(), "bare"), wood.bare);
  glBindVertexArray(wood.array.name());
  gl::stream_to(GL_ARRAY_BUFFER, wood.part_buffer, branches.parts());
  for (const meshes::trees::BranchGroup& group : branches.groups()) {
    if (group.count == 0) continue;
    const std::size_t sides = meshes::trees::Branches::kSides.at(group.tube);
    set_int(program, "rings", group.rings);
    set_int(program, "sides", sides);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, wood.tubes.at(group.tube).name());
    describe_parts(group.first);
    glDrawElementsInstanced(GL_TRIANGLES, static_cast<GLsizei>(6 * group.rings * sides), GL_UNSIGNED_INT, nullptr,
                            static_cast<GLsizei>(group.count));
  }
}

void TreeRenderer::draw_sprays(const gl::Program& program, const Foliage& foliage, const meshes::trees::Crown& crown) {
  if (crown.places().empty()) return;
  glUseProgram(program.name());
  set_int(program, "kind", static_cast<std::size_t>(foliage.shape.kind));
  gl::stream_to(GL_ARRAY_BUFFER, foliage.place_buffer, crown.places());
  for (const meshes::trees::SprayGroup& group : crown.groups()) {
    if (group.count == 0) continue;
    const SprayOnGpu& spray = foliage.sprays.at(static_cast<std::size_t>(group.kind));
    glBindVertexArray(spray.array.name());
    describe_sprays(group.first);
    glDrawElementsInstanced(GL_TRIANGLES, static_cast<GLsizei>(spray.stalk_indices + group.leaves * spray.leaf_indices),
                            GL_UNSIGNED_INT, nullptr, static_cast<GLsizei>(group.count));
  }
}

}  // namespace yuragi::viewer::looks
