#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/pose/skeleton.hpp"

namespace yuragi::viewer::meshes::trees {

// A strand of a tree's leaves is drawn as a spray: a thin stalk that bears leaves at alternate sides, or flowers.

/// The species that a tree's leaf strands tell by their proportions: narrow ones are a zelkova's, slender ones a
/// cherry's, broad ones a poplar's.
enum class LeafSpecies : std::uint8_t { kZelkova, kCherry, kPoplar };
LeafSpecies leaf_species(const pose::TreeSkeleton& tree);

/// What hangs on a tree's sprays. Lengths are shares of the spray's.
struct SprayShape {
  std::size_t leaves = 0;    ///< on a spray, near by
  float leaf_length = 0.0F;  ///< of a blade; of a flower, its diameter
  float leaf_width = 0.0F;   ///< of a blade, where it is widest, as a share of its own length
  float widest_at = 0.0F;    ///< from a blade's foot (0) to its tip (1)
  enum class Kind : std::uint8_t { kLeaves, kFlowers, kTwigs };
  Kind kind = Kind::kLeaves;  ///< twigs: what a bare tree has; their length is that of a leaf
  float silver = 0.0F;        ///< how pale the lower faces of its leaves are, 0 to 1

  bool has_flowers() const { return kind == Kind::kFlowers; }
};

/// The shape of a tree's sprays, by its species and its foliage, or another one.
SprayShape spray_shape(const pose::TreeSkeleton& tree);
SprayShape spray_shape(const pose::TreeSkeleton& tree, pose::FoliageColor foliage);

/// A corner of a spray's mesh, in the layout that the leaves' shader reads. The mesh is bent along the strand there.
struct SprayCorner {
  float at = 0.0F;      ///< where its leaf grows: 0 at the strand's foot, 1 at its tip
  float side = 0.0F;    ///< -1 or 1: at which side; 0: the leaf goes on along the strand; 2: it is of the stalk
  float along = 0.0F;   ///< in the leaf, as a share of the spray's length. Of a flower: one of its two axes
  float across = 0.0F;  ///< the same, to the right of its midrib. Of the stalk: -1 or 1
  float edge = 0.0F;    ///< 0 at the midrib or in the heart of a flower, 1 at the edge
  float leaf = 0.0F;    ///< its number; leaves with low numbers are spread over the whole spray
};

/// Triangles, leaf behind leaf.
struct SprayMesh {
  std::vector<SprayCorner> corners;
  std::vector<std::uint32_t> triangles;
  std::size_t stalk_indices = 0;  ///< of `triangles`, before the first leaf
  std::size_t leaf_indices = 0;   ///< of each leaf
};

/// For the eye near by: curved outlines, and a stalk.
SprayMesh near_spray(const SprayShape& shape);
/// For others: two triangles a leaf, folded along its midrib; a flower is a pentagon.
SprayMesh far_spray(const SprayShape& shape);
/// For leaves of a few pixels: a triangle each.
SprayMesh speck_spray(const SprayShape& shape);

/// How finely sprays are drawn.
struct SprayDetail {
  float leaf_px = 5.5F;          ///< leaves smaller than this give way to fewer, larger ones
  float largest = 4.0F;          ///< which are at most so many times as large
  float shaped_leaf_px = 40.0F;  ///< those larger than this have a curved outline
  float speck_px = 0.0F;         ///< those no larger than this, as drawn, are a triangle each
  float hidden_share = 1.0F;     ///< of its leaves, that a spray has which other leaves hide from the eye
};

/// The meshes of a spray.
enum class SprayKind : std::uint8_t { kSpeck, kFar, kNear };

/// How many leaves of a spray are drawn (below 1: of some sprays one), and how much larger each is, so that together
/// they cover as much as all of them. The count is not a whole number: the last leaf is drawn that much smaller, so
/// that leaves come and go smoothly.
struct SprayLevel {
  float leaves = 0.0F;
  float size = 1.0F;
  SprayKind kind = SprayKind::kFar;
};
/// For a spray whose leaves are as long in the picture as `leaf_px`, in pixels.
SprayLevel spray_level(const SprayShape& shape, float leaf_px, const SprayDetail& detail = {});

/// The mean length of a level's strands, metres; 0 where there are none.
float mean_length_m(const pose::StrandSkeleton& strands);

}  // namespace yuragi::viewer::meshes::trees
