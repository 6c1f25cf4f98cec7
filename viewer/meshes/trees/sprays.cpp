#include "viewer/meshes/trees/sprays.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/base/units.hpp"

namespace yuragi::viewer::meshes::trees {
namespace {

constexpr std::size_t kLeaves = 13;
constexpr std::size_t kSmallLeaves = 18;
constexpr std::size_t kFlowers = 26;
constexpr std::size_t kTwigs = 2;
constexpr std::size_t kStalkRings = 4;
constexpr int kPetals = 5;

// Half the width of a strand as a share of its length; threshold between the species.
constexpr float kNarrow = 0.225F;
constexpr float kBroad = 0.31F;

/// The number's digits in base 2, mirrored at the point: 0, 1/2, 1/4, 3/4, 1/8, ... (J. van der Corput 1935). Any first
/// part of them is spread over the whole range.
float spread(std::size_t number) {
  float value = 0.0F;
  for (float digit = 0.5F; number > 0; number /= 2, digit /= 2) value += digit * static_cast<float>(number % 2);
  return value;
}

/// The foot of a leaf, at which its corners are placed.
SprayCorner foot_of(std::size_t leaf, bool has_flowers) {
  // The first leaf is at the tip; the others are on alternating sides, down to a quarter of the way.
  const float at = 1.0F - (has_flowers ? 0.85F : 0.75F) * spread(leaf);
  const float side = leaf == 0 ? 0.0F : (std::lround(at * 8.0F) % 2 == 0 ? 1.0F : -1.0F);
  return {.at = at, .side = side, .along = 0.0F, .across = 0.0F, .edge = 0.0F, .leaf = static_cast<float>(leaf)};
}

SprayCorner moved(SprayCorner foot, float along, float across, float edge) {
  foot.along = along;
  foot.across = across;
  foot.edge = edge;
  return foot;
}

/// Half the width of a blade at `t` of its length, 1 where it is widest: round toward the foot, drawn out to the tip.
float outline(float t, float widest_at) {
  const float rise = std::min(t / widest_at, 1.0F);
  const float fall = std::clamp((1.0F - t) / (1.0F - widest_at), 0.0F, 1.0F);
  return std::sqrt(rise * (2.0F - rise)) * fall * (0.55F + 0.9F * fall - 0.45F * fall * fall);
}

/// The petiole's share of a leaf, from the stalk to the blade's foot.
constexpr float kPetiole = 0.18F;

void add_kite(SprayMesh& mesh, const SprayShape& shape, const SprayCorner& foot) {
  const auto first = static_cast<std::uint32_t>(mesh.corners.size());
  const float length = shape.leaf_length;
  const float blade_foot = kPetiole * length;
  // As wide as needed to cover the same area as the curved outline.
  const float half = 0.58F * shape.leaf_width * length;
  const float widest = blade_foot + std::clamp(shape.widest_at, 0.25F, 0.5F) * length;
  mesh.corners.insert(mesh.corners.end(),
                      {moved(foot, blade_foot, 0.0F, 0.0F), moved(foot, widest, -half, 1.0F),
                       moved(foot, widest, half, 1.0F), moved(foot, blade_foot + length, 0.0F, 0.0F)});
  mesh.triangles.insert(mesh.triangles.end(), {first, first + 1, first + 3, first, first + 3, first + 2});
}

void add_blade(SprayMesh& mesh, const SprayShape& shape, const SprayCorner& foot) {
  constexpr std::array<float, 5> kRows = {0.06F, 0.25F, 0.48F, 0.72F, 0.9F};
  const auto first = static_cast<std::uint32_t>(mesh.corners.size());
  const float length = shape.leaf_length;
  const float blade_foot = kPetiole * length;
  mesh.corners.push_back(moved(foot, blade_foot, 0.0F, 0.0F));
  for (const float t : kRows) {
    const float half = 0.5F * shape.leaf_width * length * outline(t, shape.widest_at);
    const float along = blade_foot + t * length;
    for (const float across : {-1.0F, 0.0F, 1.0F}) {
      mesh.corners.push_back(moved(foot, along, across * half, std::abs(across)));
    }
  }
  mesh.corners.push_back(moved(foot, blade_foot + length, 0.0F, 0.0F));
  const std::uint32_t left = first + 1;
  mesh.triangles.insert(mesh.triangles.end(), {first, left, left + 1, first, left + 1, left + 2});
  for (std::uint32_t row = 0; row + 1 < kRows.size(); ++row) {
    for (std::uint32_t half = 0; half < 2; ++half) {
      const std::uint32_t here = left + 3 * row + half;
      mesh.triangles.insert(mesh.triangles.end(), {here, here + 3, here + 1, here + 1, here + 3, here + 4});
    }
  }
  const auto last = static_cast<std::uint32_t>(left + 3 * (kRows.size() - 1));
  const std::uint32_t tip = last + 3;
  mesh.triangles.insert(mesh.triangles.end(), {last, tip, last + 1, last + 1, tip, last + 2});
}

/// Five petals, each with a notch at its end, around the heart.
void add_flower(SprayMesh& mesh, const SprayShape& shape, const SprayCorner& foot) {
  const auto heart = static_cast<std::uint32_t>(mesh.corners.size());
  const float radius = 0.5F * shape.leaf_length;
  mesh.corners.push_back(foot);
  for (int petal = 0; petal < kPetals; ++petal) {
    const auto at = static_cast<std::uint32_t>(mesh.corners.size());
    constexpr std::array<std::array<float, 2>, 5> kEdge = {
        {{-0.56F, 0.60F}, {-0.26F, 1.0F}, {0.0F, 0.90F}, {0.26F, 1.0F}, {0.56F, 0.60F}}};
    for (const auto& [turn_rad, out] : kEdge) {
      const float angle_rad = static_cast<float>(2.0 * kPi) * static_cast<float>(petal) / kPetals + turn_rad;
      mesh.corners.push_back(moved(foot, radius * out * std::cos(angle_rad), radius * out * std::sin(angle_rad), out));
    }
    for (std::uint32_t i = 0; i + 1 < kEdge.size(); ++i) {
      mesh.triangles.insert(mesh.triangles.end(), {heart, at + i, at + i + 1});
    }
  }
}

void add_pentagon(SprayMesh& mesh, const SprayShape& shape, const SprayCorner& foot) {
  const auto heart = static_cast<std::uint32_t>(mesh.corners.size());
  const float radius = 0.465F * shape.leaf_length;
  mesh.corners.push_back(foot);
  for (std::uint32_t petal = 0; petal < kPetals; ++petal) {
    const float angle_rad = static_cast<float>(2.0 * kPi) * static_cast<float>(petal) / kPetals;
    mesh.corners.push_back(moved(foot, radius * std::cos(angle_rad), radius * std::sin(angle_rad), 1.0F));
    mesh.triangles.insert(mesh.triangles.end(), {heart, heart + 1 + petal, heart + 1 + (petal + 1) % kPetals});
  }
}

/// A triangle that covers the same area as a kite.
void add_leaf_speck(SprayMesh& mesh, const SprayShape& shape, const SprayCorner& foot) {
  const auto first = static_cast<std::uint32_t>(mesh.corners.size());
  const float length = shape.leaf_length;
  const float blade_foot = kPetiole * length;
  const float half = 0.58F * shape.leaf_width * length;
  mesh.corners.insert(mesh.corners.end(), {moved(foot, blade_foot, -half, 1.0F), moved(foot, blade_foot, half, 1.0F),
                                           moved(foot, blade_foot + length, 0.0F, 0.0F)});
  mesh.triangles.insert(mesh.triangles.end(), {first, first + 1, first + 2});
}

/// A triangle that covers the same area as a pentagon, in the mean of its colors.
void add_flower_speck(SprayMesh& mesh, const SprayShape& shape, const SprayCorner& foot) {
  const auto first = static_cast<std::uint32_t>(mesh.corners.size());
  const float radius = 0.63F * shape.leaf_length;
  for (std::uint32_t corner = 0; corner < 3; ++corner) {
    const float angle_rad = static_cast<float>(2.0 * kPi) * static_cast<float>(corner) / 3.0F;
    mesh.corners.push_back(moved(foot, radius * std::cos(angle_rad), radius * std::sin(angle_rad), 0.6F));
  }
  mesh.triangles.insert(mesh.triangles.end(), {first, first + 1, first + 2});
}

/// The spray's own axis is the first; the others branch off, and get thinner toward their tips.
void add_twig(SprayMesh& mesh, const SprayShape& shape, const SprayCorner& foot) {
  const auto first = static_cast<std::uint32_t>(mesh.corners.size());
  for (const float t : {0.0F, 0.5F, 1.0F}) {
    SprayCorner ring = foot.leaf == 0.0F ? foot : moved(foot, t * shape.leaf_length, 0.0F, 0.0F);
    if (foot.leaf == 0.0F) ring.at = t;
    const float thickness = (foot.leaf == 0.0F ? 1.0F : 0.7F) * (1.0F - 0.7F * t);
    mesh.corners.insert(mesh.corners.end(),
                        {moved(ring, ring.along, -1.0F, thickness), moved(ring, ring.along, 1.0F, thickness)});
  }
  for (const std::uint32_t i : {first, first + 2}) {
    mesh.triangles.insert(mesh.triangles.end(), {i, i + 1, i + 2, i + 1, i + 3, i + 2});
  }
}

void add_stalk(SprayMesh& mesh) {
  for (std::size_t ring = 0; ring <= kStalkRings; ++ring) {
    for (const float across : {-1.0F, 1.0F}) {
      mesh.corners.push_back({.at = static_cast<float>(ring) / kStalkRings,
                              .side = 2.0F,
                              .along = 0.0F,
                              .across = across,
                              .edge = 0.0F,
                              .leaf = 0.0F});
    }
  }
  for (std::uint32_t ring = 0; ring < kStalkRings; ++ring) {
    const std::uint32_t i = 2 * ring;
    mesh.triangles.insert(mesh.triangles.end(), {i, i + 1, i + 2, i + 1, i + 3, i + 2});
  }
  mesh.stalk_indices = mesh.triangles.size();
}

template <class AddLeaf>
SprayMesh spray_of(const SprayShape& shape, bool has_stalk, AddLeaf&& add_leaf) {
  SprayMesh mesh;
  if (has_stalk) add_stalk(mesh);
  for (std::size_t leaf = 0; leaf < shape.leaves; ++leaf) add_leaf(mesh, shape, foot_of(leaf, shape.has_flowers()));
  mesh.leaf_indices = (mesh.triangles.size() - mesh.stalk_indices) / std::max<std::size_t>(shape.leaves, 1);
  return mesh;
}

}  // namespace

float mean_length_m(const pose::StrandSkeleton& strands) {
  float sum_m = 0.0F;
  for (std::size_t i = 0; i < strands.strand_count; ++i) sum_m += strands.link_length_m[i];
  return sum_m * static_cast<float>(strands.links_per_strand) /
         static_cast<float>(std::max<std::size_t>(strands.strand_count, 1));
}

LeafSpecies leaf_species(const pose::TreeSkeleton& tree) {
  float half_width_m = 0.0F;
  float length_m = 0.0F;
  for (const pose::TreeLevel& level : tree.levels) {
    if (!level.is_leaves) continue;
    length_m += mean_length_m(level.strands) * static_cast<float>(level.strands.strand_count);
    for (std::size_t i = 0; i < level.strands.strand_count; ++i) half_width_m += level.base_radius_m[i];
  }
  const float half_width = half_width_m / std::max(length_m, 1e-6F);
  if (half_width < kNarrow) return LeafSpecies::kZelkova;
  return half_width < kBroad ? LeafSpecies::kCherry : LeafSpecies::kPoplar;
}

SprayShape spray_shape(const pose::TreeSkeleton& tree) {
  return spray_shape(tree, tree.foliage);
}

SprayShape spray_shape(const pose::TreeSkeleton& tree, pose::FoliageColor foliage) {
  // Sprays are 26 to 28 cm long.
  if (foliage == pose::FoliageColor::kBlossom) {  // flowers of 3.1 cm
    return {.leaves = kFlowers,
            .leaf_length = 0.112F,
            .leaf_width = 1.0F,
            .widest_at = 0.5F,
            .kind = SprayShape::Kind::kFlowers};
  }
  if (foliage == pose::FoliageColor::kBare) {
    return {.leaves = kTwigs,
            .leaf_length = 0.45F,
            .leaf_width = 0.02F,
            .widest_at = 0.5F,
            .kind = SprayShape::Kind::kTwigs};
  }
  switch (leaf_species(tree)) {
    case LeafSpecies::kZelkova:  // 7 cm
      return {.leaves = kSmallLeaves, .leaf_length = 0.24F, .leaf_width = 0.44F, .widest_at = 0.38F, .silver = 0.1F};
    case LeafSpecies::kCherry:  // 8 cm
      return {.leaves = kLeaves, .leaf_length = 0.29F, .leaf_width = 0.52F, .widest_at = 0.42F, .silver = 0.2F};
    case LeafSpecies::kPoplar:  // 6 cm, wider than long, widest near its foot
      break;
  }
  return {.leaves = kLeaves, .leaf_length = 0.24F, .leaf_width = 1.10F, .widest_at = 0.22F, .silver = 1.0F};
}

SprayMesh near_spray(const SprayShape& shape) {
  if (shape.kind == SprayShape::Kind::kTwigs) return spray_of(shape, false, add_twig);
  return spray_of(shape, true, shape.has_flowers() ? add_flower : add_blade);
}

SprayMesh far_spray(const SprayShape& shape) {
  if (shape.kind == SprayShape::Kind::kTwigs) return spray_of(shape, false, add_twig);
  return spray_of(shape, false, shape.has_flowers() ? add_pentagon : add_kite);
}

SprayMesh speck_spray(const SprayShape& shape) {
  if (shape.kind == SprayShape::Kind::kTwigs) return spray_of(shape, false, add_twig);
  return spray_of(shape, false, shape.has_flowers() ? add_flower_speck : add_leaf_speck);
}

SprayLevel spray_level(const SprayShape& shape, float leaf_px, const SprayDetail& detail) {
  const auto all = static_cast<float>(shape.leaves);
  const float share = std::clamp(std::min(leaf_px / detail.leaf_px, 1e3F), 1.0F / detail.largest, 1.0F);
  const bool is_near = leaf_px > detail.shaped_leaf_px;
  // A triangle is more noticeable if it replaces a pale round flower.
  const float largest_speck_px = (shape.has_flowers() ? 0.5F : 1.0F) * detail.speck_px;
  const bool is_speck = leaf_px / share <= largest_speck_px;
  return {.leaves = all * share * share,
          .size = 1.0F / share,
          .kind = is_near ? SprayKind::kNear : (is_speck ? SprayKind::kSpeck : SprayKind::kFar)};
}

}  // namespace yuragi::viewer::meshes::trees
