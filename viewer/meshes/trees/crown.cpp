#include "viewer/meshes/trees/crown.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

namespace yuragi::viewer::meshes::trees {
namespace {

constexpr float kNearest_m = 0.3F;

/// A bare twig follows its parent's direction more than a strand of leaves does.
constexpr float kTwigAlong = 0.3F;

/// A spray whose visible share is above this has all of its leaves; a hidden one has fewer, which are larger, up to
/// this factor.
constexpr float kHardlySeen = 0.35F;
constexpr float kMaxHidden = 1.4F;

/// There are meshes with these numbers of leaves; a spray is drawn with the smallest sufficient one.
constexpr std::array<std::size_t, 9> kLeafCounts = {1, 2, 3, 4, 6, 9, 13, 18, 26};

/// The number's 4 digits in base 2, mirrored: any first few numbers are spread over all 16.
std::size_t mirrored(std::size_t number) {
  return (number & 1U) << 3U | (number & 2U) << 1U | (number & 4U) >> 1U | (number & 8U) >> 3U;
}

/// `v`, turned by the shortest rotation from `from` to `to` (unit vectors).
glm::vec3 turned(const glm::vec3& v, const glm::vec3& from, const glm::vec3& to) {
  const glm::vec3 axis = glm::cross(from, to);
  const float cosine = glm::dot(from, to);
  return cosine * v + glm::cross(axis, v) + axis * (glm::dot(axis, v) / std::max(1.0F + cosine, 0.05F));
}

glm::vec3 vector_of(const std::array<float, 3>& v) {
  return {v[0], v[1], v[2]};
}
glm::vec3 vector_of(const pose::JointPosition& v) {
  return {v.x_m, v.y_m, v.z_m};
}

glm::vec3 direction_to(const glm::vec3& from, const glm::vec3& to) {
  const glm::vec3 way = to - from;
  return way / std::max(glm::length(way), 1e-6F);
}

/// The cells of a box, and the leaf area in each.
class LeafCells {
 public:
  static constexpr int kSide = 28;
  /// More than any tree needs; a hostile one can be so large, or so far away, that a step makes no progress.
  static constexpr int kMaxSteps = 1000;
  static constexpr std::size_t kCells = std::size_t{kSide} * kSide * kSide;

  explicit LeafCells(const Bounds& box)
      : low_m_(box.low_m - 0.2F), cell_m_((box.high_m - box.low_m + 0.4F) / static_cast<float>(kSide)) {}

  void add(const glm::vec3& place_m, float area_m2) {
    const int cell = cell_of(place_m);
    if (cell >= 0) density_[static_cast<std::size_t>(cell)] += area_m2 / (cell_m_.x * cell_m_.y * cell_m_.z);
  }

  /// The share of light that reaches a place along `direction`.
  float light_from(glm::vec3 place_m, const glm::vec3& direction) const {
    const float step_m = 0.7F * std::min({cell_m_.x, cell_m_.y, cell_m_.z});
    float leaves = 0.0F;  // across the light, area over area
    place_m += 0.5F * step_m * direction;
    for (int step = 0; step < kMaxSteps; ++step, place_m += step_m * direction) {
      const int cell = cell_of(place_m);
      if (cell < 0) break;
      leaves += 0.5F * step_m * density_[static_cast<std::size_t>(cell)];
    }
    return std::exp(-leaves);
  }

 private:
  int cell_of(const glm::vec3& place_m) const {
    const glm::vec3 at = (place_m - low_m_) / cell_m_;
    const glm::ivec3 cell(glm::floor(at));
    for (int axis = 0; axis < 3; ++axis) {
      if (cell[axis] < 0 || cell[axis] >= kSide) return -1;
    }
    return (cell.z * kSide + cell.y) * kSide + cell.x;
  }

  glm::vec3 low_m_;
  glm::vec3 cell_m_;
  std::vector<float> density_ = std::vector<float>(kCells, 0.0F);
};

}  // namespace

std::vector<glm::vec4> crown_openness(const pose::TreeSkeleton& tree, std::size_t level, const SprayShape& shape) {
  const pose::StrandSkeleton& strands = tree.levels[level].strands;
  std::vector<glm::vec4> open(strands.strand_count);
  const auto middle_m = [&](std::size_t i) {
    const float half_m = 0.5F * strands.link_length_m[i] * static_cast<float>(strands.links_per_strand);
    return glm::vec3(strands.root_x_m[i], strands.root_y_m[i], strands.root_z_m[i]) +
           half_m * glm::vec3(strands.rest_x[i], strands.rest_y[i], strands.rest_z[i]);
  };
  if (open.empty()) return open;
  Bounds box{middle_m(0), middle_m(0)};
  for (std::size_t i = 0; i < open.size(); ++i) box = united(box, {middle_m(i), middle_m(i)});
  LeafCells cells(box);
  for (std::size_t i = 0; i < open.size(); ++i) {
    const float length_m = strands.link_length_m[i] * static_cast<float>(strands.links_per_strand);
    const float leaf_m = shape.leaf_length * length_m;
    cells.add(middle_m(i), 0.6F * static_cast<float>(shape.leaves) * shape.leaf_width * leaf_m * leaf_m);
  }

  // The first two bands of spherical harmonics, of 14 directions: to the faces and the corners of a cube.
  std::vector<glm::vec3> directions;
  for (const float sign : {-1.0F, 1.0F}) {
    for (int axis = 0; axis < 3; ++axis) directions.emplace_back(0.0F)[axis] = sign;
    for (int corner = 0; corner < 4; ++corner) {
      directions.push_back(sign * glm::normalize(glm::vec3((corner & 1) * 2 - 1, (corner & 2) - 1, 1.0F)));
    }
  }
  for (std::size_t i = 0; i < open.size(); ++i) {
    glm::vec4 sum(0.0F);
    for (const glm::vec3& direction : directions) {
      const float light = cells.light_from(middle_m(i), direction);
      sum += light * glm::vec4(3.0F * direction, 1.0F);
    }
    open[i] = sum / static_cast<float>(directions.size());
  }
  return open;
}

Crown::Crown(const pose::TreeSkeleton& tree, std::size_t level) : Crown(tree, level, tree.foliage) {}

Crown::Crown(const pose::TreeSkeleton& tree, std::size_t level, pose::FoliageColor foliage)
    : tree_(&tree),
      level_(level),
      shape_(spray_shape(tree, foliage)),
      is_stiff_(foliage == pose::FoliageColor::kBare && tree.foliage != foliage && level > 0),
      leaf_m_(shape_.leaf_length * mean_length_m(tree.levels[level].strands)),
      parts_(tree_parts(tree, level, foliage)),
      sprays_(parts_.size()),
      balls_((parts_.size() + pose::kStrandsPerBlock - 1) / pose::kStrandsPerBlock),
      choices_(balls_.size()),
      chosen_(parts_.size()) {
  const std::vector<glm::vec4> open = crown_openness(tree, level, shape_);
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    SprayPlace& spray = sprays_[i];
    spray.length_m = parts_[i].tip_radius_m;
    spray.tint = vector_of(parts_[i].tint);
    spray.number = static_cast<float>(i);
    spray.open = open[i];
  }
  for (const std::size_t count : kLeafCounts) {
    if (count >= shape_.leaves) continue;
    groups_.push_back({.kind = SprayKind::kSpeck, .leaves = count});
    groups_.push_back({.kind = SprayKind::kFar, .leaves = count});
  }
  groups_.push_back({.kind = SprayKind::kSpeck, .leaves = shape_.leaves});
  groups_.push_back({.kind = SprayKind::kFar, .leaves = shape_.leaves});
  groups_.push_back({.kind = SprayKind::kNear, .leaves = shape_.leaves});
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const std::size_t block = i / pose::kStrandsPerBlock;
    balls_[block].open += open[i] / static_cast<float>(strands_in(block));
  }
}

std::size_t Crown::strands_in(std::size_t block) const {
  return std::min(pose::kStrandsPerBlock, parts_.size() - block * pose::kStrandsPerBlock);
}

/// Turns a strand of leaves into a twig: it does not hang, and has the direction of the link that it grows from.
void Crown::straighten(SprayPlace& spray, std::size_t strand, const pose::TreeJoints& joints) const {
  const pose::TreeLevel& level = tree_->levels[level_];
  const std::size_t parent = level.parent[strand];
  const std::size_t link = level.parent_link[strand];
  const glm::vec3 before = link_at_rest(tree_->levels[level.parent_level].strands, parent, link);
  const glm::vec3 foot_m =
      link == 0 ? spray.root_m : vector_of(joints.level(level.parent_level).joint(parent, link - 1));
  const glm::vec3 now = link == 0 ? before : direction_to(foot_m, spray.root_m);
  const glm::vec3 grown = glm::normalize(glm::mix(link_at_rest(level.strands, strand, 0), before, kTwigAlong) + 1e-4F);
  spray.tip_m = spray.root_m + spray.length_m * turned(grown, before, now);
  spray.bow_m = glm::vec3(0.0F);
}

void Crown::move_to(const pose::TreeJoints& joints) {
  const pose::TreeLevel& level = tree_->levels[level_];
  const std::size_t links = level.strands.links_per_strand;
  const pose::JointPositions& own = joints.level(level_);
  blown_ = 0.0F;
  for (std::size_t block = 0; block < balls_.size(); ++block) {
    glm::vec3 sum_m(0.0F);
    const std::size_t first = block * pose::kStrandsPerBlock;
    const std::size_t count = strands_in(block);
    for (std::size_t i = first; i < first + count; ++i) {
      SprayPlace& spray = sprays_[i];
      // The parabola through its root, one of its joints near the middle, and its tip.
      spray.root_m = level_ == 0
                         ? vector_of(parts_[i].root_m)
                         : vector_of(joints.level(level.parent_level).joint(level.parent[i], level.parent_link[i]));
      spray.tip_m = vector_of(own.joint(i, links - 1));
      spray.bow_m = glm::vec3(0.0F);
      if (links > 1) {
        const std::size_t half = links / 2;
        const float u = static_cast<float>(half) / static_cast<float>(links);
        const glm::vec3 middle_m = vector_of(own.joint(i, half - 1));
        spray.bow_m = (middle_m - glm::mix(spray.root_m, spray.tip_m, u)) / (u * (1.0F - u));
      }
      if (is_stiff_) straighten(spray, i, joints);
      const glm::vec3 rest = vector_of(parts_[i].rest);
      const glm::vec3 to = direction_to(spray.root_m, spray.tip_m);
      spray.upper = turned(vector_of(parts_[i].facing), rest, to);
      spray.blown = glm::dot(to - rest, to - rest);
      blown_ += spray.blown;
      sum_m += spray.root_m + spray.tip_m;
    }
    Ball& ball = balls_[block];
    ball.middle_m = sum_m / static_cast<float>(2 * count);
    ball.radius_m = 0.0F;
    for (std::size_t i = first; i < first + count; ++i) {
      ball.radius_m = std::max({ball.radius_m, glm::distance(ball.middle_m, sprays_[i].root_m),
                                glm::distance(ball.middle_m, sprays_[i].tip_m)});
    }
    ball.radius_m += 2.0F * leaf_m_;
  }
  blown_ /= static_cast<float>(std::max<std::size_t>(parts_.size(), 1));
}

void Crown::choose(const View& view, const SprayDetail& detail, const Place& place) {
  const auto planes = side_planes(view);
  const glm::vec3 eye_m(view.eye_m);
  for (SprayGroup& group : groups_) group.count = 0;
  for (std::size_t block = 0; block < balls_.size(); ++block) {
    Choice& choice = choices_[block];
    const glm::vec4 middle_m(place.moved(balls_[block].middle_m), 1.0F);
    const float radius_m = place.scale * balls_[block].radius_m;
    choice.is_seen = std::all_of(planes.begin(), planes.end(),
                                 [&](const glm::vec4& plane) { return glm::dot(plane, middle_m) >= -radius_m; });
    if (!choice.is_seen) continue;
    const float distance_m = std::max(glm::distance(eye_m, glm::vec3(middle_m)), kNearest_m);
    choice.level = spray_level(shape_, place.scale * leaf_m_ / (view.eye_m.w * distance_m), detail);
    if (choice.level.kind != SprayKind::kNear) {
      // The visible share equals the share of light that comes from the eye's direction.
      const glm::vec4& open = balls_[block].open;
      const glm::vec3 to_eye = (eye_m - glm::vec3(middle_m)) / distance_m;
      const float seen = open.w + glm::dot(place.turned(glm::vec3(open)), to_eye);
      const float share = glm::mix(detail.hidden_share, 1.0F, glm::smoothstep(0.0F, kHardlySeen, seen));
      choice.level.leaves *= share;
      choice.level.size *= std::min(1.0F / std::sqrt(share), kMaxHidden);
    }
    const auto suffices = [&](const SprayGroup& group) {
      return group.kind == choice.level.kind && static_cast<float>(group.leaves) >= choice.level.leaves;
    };
    choice.group = static_cast<std::size_t>(std::find_if(groups_.begin(), groups_.end(), suffices) - groups_.begin());
    // If each has less than one leaf, only some sprays have one.
    const std::size_t strands = strands_in(block);
    for (std::size_t i = 0; i < strands; ++i) {
      if (choice.level.leaves * 16.0F > static_cast<float>(mirrored(i))) ++groups_[choice.group].count;
    }
  }
  chosen_count_ = 0;
  for (SprayGroup& group : groups_) {
    group.first = chosen_count_;
    chosen_count_ += group.count;
    group.count = 0;
  }
  for (std::size_t block = 0; block < balls_.size(); ++block) {
    const Choice& choice = choices_[block];
    if (!choice.is_seen) continue;
    SprayGroup& group = groups_[choice.group];
    const std::size_t strands = strands_in(block);
    for (std::size_t i = 0; i < strands; ++i) {
      const float before = static_cast<float>(mirrored(i));
      if (choice.level.leaves * 16.0F <= before) continue;
      SprayPlace& spray = chosen_[group.first + group.count++];
      spray = sprays_[block * pose::kStrandsPerBlock + i];
      spray.root_m = place.moved(spray.root_m);
      spray.tip_m = place.moved(spray.tip_m);
      spray.bow_m = place.scale * place.turned(spray.bow_m);
      spray.upper = place.turned(spray.upper);
      spray.open = glm::vec4(place.turned(glm::vec3(spray.open)), spray.open.w);
      spray.length_m *= place.scale;
      spray.leaves =
          choice.level.leaves >= 1.0F ? choice.level.leaves : std::min(choice.level.leaves * 16.0F - before, 1.0F);
      spray.size = choice.level.size;
    }
  }
}

}  // namespace yuragi::viewer::meshes::trees
