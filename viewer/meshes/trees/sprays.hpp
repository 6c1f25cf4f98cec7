#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/pose/skeleton.hpp"

namespace yuragi::viewer::meshes::trees {

// A strand of a tree's leaves is drawn as a spray: a thin stalk with leaves on alternating sides, or with flowers.

/// The species, recognized by the proportions of a tree's leaf strands: narrow ones are a zelkova's, slender ones a
/// cherry's, broad ones a poplar's.
enum class LeafSpecies : std::uint8_t { kZelkova, kCherry, kPoplar };
LeafSpecies leaf_species(const pose::TreeSkeleton& tree);

/// The shape of a tree's sprays. Lengths are shares of the spray's.
struct SprayShape {
  std::size_t leaves = 0;    ///< number on a spray, near by
  float leaf_length = 0.0F;  ///< of a blade; of a flower, its diameter
  float leaf_width = 0.0F;   ///< maximum width of a blade, as a share of its length
  float widest_at = 0.0F;    ///< position of the maximum width, from a blade's foot (0) to its tip (1)
  enum class Kind : std::uint8_t { kLeaves, kFlowers, kTwigs };
  Kind kind = Kind::kLeaves;  ///< twigs: those of a bare tree; their length is that of a leaf
  float silver = 0.0F;        ///< paleness of the lower faces of its leaves, 0 to 1

  bool has_flowers() const { return kind == Kind::kFlowers; }
};

/// The shape of a tree's sprays, by its species and its foliage, or another one.
SprayShape spray_shape(const pose::TreeSkeleton& tree);
SprayShape spray_shape(const pose::TreeSkeleton& tree, pose::FoliageColor foliage);

/// A corner of a spray's mesh, in the layout of the leaves' shader, which bends the mesh along the strand.
struct SprayCorner {
  float at = 0.0F;      ///< position of its leaf: 0 at the strand's foot, 1 at its tip
  float side = 0.0F;    ///< -1 or 1: its side; 0: the leaf continues the strand; 2: it belongs to the stalk
  float along = 0.0F;   ///< in the leaf, as a share of the spray's length. For a flower: one of its two axes
  float across = 0.0F;  ///< the same, to the right of its midrib. For the stalk: -1 or 1
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

/// For near sprays: curved outlines, and a stalk.
SprayMesh near_spray(const SprayShape& shape);
/// For distant ones: two triangles a leaf, folded along its midrib; a flower is a pentagon.
SprayMesh far_spray(const SprayShape& shape);
/// For leaves of a few pixels: a triangle each.
SprayMesh speck_spray(const SprayShape& shape);

/// How finely sprays are drawn.
struct SprayDetail {
  float leaf_px = 5.5F;          ///< leaves smaller than this are replaced by fewer, larger ones
  float largest = 4.0F;          ///< at most this many times as large
  float shaped_leaf_px = 40.0F;  ///< larger leaves have a curved outline
  float speck_px = 0.0F;         ///< leaves up to this size, as drawn, are single triangles
  float hidden_share = 1.0F;     ///< share of its leaves that a spray has if other leaves hide it
};

/// The meshes of a spray.
enum class SprayKind : std::uint8_t { kSpeck, kFar, kNear };

/// The number of leaves of a spray that are drawn (below 1: one, of some sprays), and their enlargement, so that
/// together they cover the same area as all of them. The number is fractional: the last leaf is drawn smaller by its
/// fraction, so that leaves appear and disappear smoothly.
struct SprayLevel {
  float leaves = 0.0F;
  float size = 1.0F;
  SprayKind kind = SprayKind::kFar;
};
/// For a spray whose leaves are `leaf_px` pixels long in the picture.
SprayLevel spray_level(const SprayShape& shape, float leaf_px, const SprayDetail& detail = {});

/// The mean length of a level's strands, metres; 0 if there are none.
float mean_length_m(const pose::StrandSkeleton& strands);

}  // namespace yuragi::viewer::meshes::trees
