#include "viewer/meshes/trees/tree_parts.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/base/units.hpp"
#include "engine/math/philox.hpp"
#include "viewer/meshes/trees/sprays.hpp"

namespace yuragi::viewer::meshes::trees {
namespace {

const glm::vec3 kBark(0.080F, 0.068F, 0.056F);
const glm::vec3 kTwig(0.085F, 0.065F, 0.048F);

constexpr double kLeafTilt_rad = 0.75;  // about the largest angle between a leaf's upper side and the sky
// A zelkova's limbs first rise steeply, and then curve outward: each is drawn that far inward of its joints, and to one
// side, relative to its length without twigs. Inward: for each metre that its foot leans out on a metre of height; from
// 0.148 on it would lean inward. Bows differ, so that no two limbs are alike.
constexpr float kInward = 0.115F;
constexpr float kInwardVaries = 0.025F;
constexpr float kAsideVaries = 0.030F;

constexpr float kOutward = 0.8F;  // how much it is turned out of the crown, toward the light, against that

struct LeafTints {
  glm::vec3 deep;
  glm::vec3 fresh;
};

LeafTints autumn_of(LeafSpecies species) {
  switch (species) {
    case LeafSpecies::kZelkova:
      return {{0.24F, 0.062F, 0.014F}, {0.46F, 0.21F, 0.030F}};
    case LeafSpecies::kCherry:
      return {{0.28F, 0.026F, 0.012F}, {0.55F, 0.17F, 0.028F}};
    case LeafSpecies::kPoplar:
      break;
  }
  return {{0.36F, 0.22F, 0.020F}, {0.62F, 0.46F, 0.045F}};
}

LeafTints tints_of(const pose::TreeSkeleton& tree, pose::FoliageColor foliage) {
  switch (foliage) {
    case pose::FoliageColor::kBlossom:
      return {{0.74F, 0.55F, 0.60F}, {0.86F, 0.76F, 0.79F}};
    case pose::FoliageColor::kAutumn:
      return autumn_of(leaf_species(tree));
    case pose::FoliageColor::kBare:
      return {kTwig, 1.4F * kTwig};
    case pose::FoliageColor::kGreen:
      break;
  }
  // An old leaf, and a young one.
  return {{0.040F, 0.092F, 0.028F}, {0.085F, 0.150F, 0.038F}};
}

/// The vector from a strand's foot to its tip at rest.
glm::vec3 rest_direction(const pose::StrandSkeleton& strands, std::size_t i) {
  glm::vec3 sum(0.0F);
  for (std::size_t link = 0; link < strands.links_per_strand; ++link) sum += link_at_rest(strands, i, link);
  const float length = glm::length(sum);
  return length > 1e-3F ? sum / length : link_at_rest(strands, i, 0);
}

/// How far a limb is drawn aside of its joints, metres.
glm::vec3 bow_m(const pose::StrandSkeleton& strands, std::size_t i, float bare, double chance, double other_chance) {
  const glm::vec3 foot = link_at_rest(strands, i, 0);
  const glm::vec3 level(foot.x, 0.0F, foot.z);
  const float lean = glm::length(level) / std::max(foot.y, 0.3F);
  if (lean < 1e-3F) return glm::vec3(0.0F);
  const glm::vec3 outward = glm::normalize(level);
  const glm::vec3 aside(-outward.z, 0.0F, outward.x);
  const float bare_m = bare * strands.link_length_m[i] * static_cast<float>(strands.links_per_strand);
  const auto varied = [](float most, double uniform) { return most * (2.0F * static_cast<float>(uniform) - 1.0F); };
  return bare_m *
         ((varied(kInwardVaries, chance) - kInward) * lean * outward + varied(kAsideVaries, other_chance) * aside);
}

/// The middle of the strands' roots.
glm::vec3 middle_of(const pose::StrandSkeleton& strands) {
  glm::vec3 sum(0.0F);
  for (std::size_t i = 0; i < strands.strand_count; ++i) {
    sum += glm::vec3(strands.root_x_m[i], strands.root_y_m[i], strands.root_z_m[i]);
  }
  return sum / static_cast<float>(std::max<std::size_t>(strands.strand_count, 1));
}

std::array<float, 3> array_of(const glm::vec3& v) {
  return {v.x, v.y, v.z};
}

}  // namespace

std::size_t first_joint_at(const pose::TreeSkeleton& tree, std::size_t level) {
  std::size_t first = 0;
  for (std::size_t i = 0; i < level; ++i) {
    const pose::StrandSkeleton& strands = tree.levels[i].strands;
    first += strands.padded_count() * strands.links_per_strand * 3;
  }
  return first;
}

float bare_share(const pose::TreeSkeleton& tree, std::size_t level) {
  const auto links = static_cast<float>(tree.levels[level].strands.links_per_strand);
  float bare = 1.0F;
  for (const pose::TreeLevel& grown : tree.levels) {
    if (grown.strands.strand_count == 0 || &grown == tree.levels.data() || grown.parent_level != level) continue;
    for (const auto link : grown.parent_link) bare = std::min(bare, static_cast<float>(link) / links);
  }
  return bare;
}

glm::vec3 link_at_rest(const pose::StrandSkeleton& strands, std::size_t strand, std::size_t link) {
  const glm::vec3 rest(strands.rest_x[strand], strands.rest_y[strand], strands.rest_z[strand]);
  const glm::vec3 curl(strands.curl_x[strand], strands.curl_y[strand], strands.curl_z[strand]);
  const float curled_rad = static_cast<float>(link) * strands.rest_curl_rad[strand];
  return std::cos(curled_rad) * rest + std::sin(curled_rad) * curl;
}

std::vector<Part> tree_parts(const pose::TreeSkeleton& tree, std::size_t level) {
  return tree_parts(tree, level, tree.foliage);
}

std::vector<Part> tree_parts(const pose::TreeSkeleton& tree, std::size_t level, pose::FoliageColor foliage) {
  const pose::TreeLevel& from = tree.levels[level];
  const LeafTints tints = tints_of(tree, foliage);
  const math::RandomStream chance(level, math::stream_id("viewer tree"));
  const math::RandomStream twigs(level, math::stream_id("viewer tree's twigs"));
  const pose::StrandSkeleton& strands = from.strands;
  std::vector<Part> parts(strands.strand_count);
  const glm::vec3 middle_m = middle_of(strands);
  const bool is_vase = level == 1 && !from.is_leaves && leaf_species(tree) == LeafSpecies::kZelkova;
  const float bare = is_vase ? bare_share(tree, level) : 0.0F;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto [first, second] = chance.uniform_pair(2 * i);
    const auto [third, fourth] = chance.uniform_pair(2 * i + 1);
    Part& part = parts[i];
    part.root_m = {strands.root_x_m[i], strands.root_y_m[i], strands.root_z_m[i]};
    part.strand = static_cast<std::uint32_t>(i);
    part.base_radius_m = from.base_radius_m[i];
    part.tip_radius_m =
        from.is_leaves ? strands.link_length_m[i] * static_cast<float>(strands.links_per_strand) : from.tip_radius_m[i];
    if (level > 0) {
      // The layout of JointPositions: blocks of strands, links, axes, lanes.
      const std::size_t links = tree.levels[from.parent_level].strands.links_per_strand;
      const std::size_t block = from.parent[i] / pose::kStrandsPerBlock;
      part.root_at = static_cast<std::int32_t>(first_joint_at(tree, from.parent_level) +
                                               (block * links + from.parent_link[i]) * 3 * pose::kStrandsPerBlock +
                                               from.parent[i] % pose::kStrandsPerBlock);
    }

    const auto light = static_cast<float>(0.85 + 0.3 * second);
    const double bearing = 2.0 * kPi * third;
    if (from.is_leaves) {
      const double tilt = 2.0 * kLeafTilt_rad * fourth;
      const glm::vec3 up(std::sin(tilt) * std::cos(bearing), std::cos(tilt), std::sin(tilt) * std::sin(bearing));
      const glm::vec3 from_middle_m = glm::vec3(part.root_m[0], part.root_m[1], part.root_m[2]) - middle_m;
      const glm::vec3 outward = from_middle_m / std::max(glm::length(from_middle_m), 0.1F);
      part.facing = array_of(glm::normalize(up + kOutward * outward));
      part.rest = array_of(rest_direction(strands, i));
      // Those of a twig are equal.
      const double twig = level > 0 ? twigs.uniform(from.parent[i]) : first;
      part.tint = array_of(light * glm::mix(tints.deep, tints.fresh, static_cast<float>(0.4 * first + 0.6 * twig)));
    } else {
      // The direction of the tube's seam: any that is not along the branch.
      const glm::vec3 rest(strands.rest_x[i], strands.rest_y[i], strands.rest_z[i]);
      part.facing = array_of(std::abs(rest.y) > 0.7F ? glm::vec3(1.0F, 0.0F, 0.0F) : glm::vec3(0.0F, 1.0F, 0.0F));
      if (is_vase) part.rest = array_of(bow_m(strands, i, bare, third, fourth));
      part.tint = array_of(light * (level == 0 ? kBark : kTwig));
    }
  }
  return parts;
}

}  // namespace yuragi::viewer::meshes::trees
