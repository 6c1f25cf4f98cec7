#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <variant>
#include <vector>

namespace yuragi::pose {

// World: right-handed, x east, y up, z south; metres and radians.
//
// A skeleton is what never changes of a thing that sways; a pose is what moves, in the skeleton's layout. Joint
// positions come from the two by forward kinematics (kinematics.hpp), and nowhere else.

/// Strands, and the columns of a grid, are computed in blocks of this many, side by side in SIMD lanes. Arrays are
/// padded to whole blocks.
inline constexpr std::size_t kStrandsPerBlock = 16;

constexpr std::size_t padded_to_blocks(std::size_t count) {
  return (count + kStrandsPerBlock - 1) / kStrandsPerBlock * kStrandsPerBlock;
}

/// Many chains of the same number of links: grass, fur.
///
/// At rest a chain leaves its root along `rest` and curls by `rest_curl_rad` from each link to the next toward `curl`.
/// All vectors have padded_to_blocks(strand_count) elements; elements from strand_count on are finite and not shown.
struct StrandSkeleton {
  std::size_t strand_count = 0;
  std::size_t links_per_strand = 0;
  std::vector<float> root_x_m, root_y_m, root_z_m;
  std::vector<float> rest_x, rest_y, rest_z;  ///< unit vector: direction of the first link at rest
  std::vector<float> curl_x, curl_y, curl_z;  ///< unit vector across `rest`: the direction of the curl
  std::vector<float> rest_curl_rad;           ///< between one link and the next, at rest
  std::vector<float> link_length_m;
  /// For strands that represent all of the ground around them, on a grid with even spacings: the number in a row from
  /// west to east; rows follow each other from north to south, and strand_count is a multiple. 0: not on a grid.
  std::size_t columns = 0;

  std::size_t padded_count() const { return padded_to_blocks(strand_count); }
  friend bool operator==(const StrandSkeleton&, const StrandSkeleton&) = default;
};

/// One bend for each strand: the vector (east, south) toward which its tip link is turned, its length the angle in
/// radians. Link i of n (from 1) is turned from its rest direction by i/n of that angle about the horizontal axis
/// across the bend (up x bend), so that the chain makes an arc. (0, 0) is the rest pose. Both vectors have
/// padded_count() elements.
struct StrandPose {
  std::vector<float> bend_east_rad;
  std::vector<float> bend_south_rad;
};

/// Cloth: a grid of joints. Row 0 is the fixed edge (a curtain's top, a flag's hoist) and the last row the free one; a
/// column is a thread from the one to the other. The joint of (column, row) is at index row * stride() + column; all
/// vectors have rows * stride() elements, those from `columns` on in a row are finite and not shown.
struct GridSkeleton {
  std::size_t columns = 0;
  std::size_t rows = 0;
  bool is_first_column_fixed = false;  ///< a banner's pole: it stays, and the cross-arm may turn about it
  std::vector<float> rest_x_m, rest_y_m, rest_z_m;

  std::size_t stride() const { return padded_to_blocks(columns); }
  friend bool operator==(const GridSkeleton&, const GridSkeleton&) = default;
};

/// The displacement of each joint from its place at rest, in the skeleton's layout. Zero is the rest pose. The fixed
/// edge stays 0; but if the first column is fixed, that stays 0 and the edge can turn about it.
struct GridPose {
  std::vector<float> offset_x_m, offset_y_m, offset_z_m;
};

/// One generation of a tree's strands: the trunk, the limbs, the twigs, the leaves.
///
/// `strands` is their rest pose. Strand s of a level above the first grows from the joint after link parent_link[s]
/// (from 0) of strand parent[s] of level parent_level, and moves with it: its root stays at that joint, and its rest
/// direction and curl are turned with that link. If `is_turned_by_block` is set, the 16 strands of a block all take the
/// turn of the first one's parent link (a spray of leaves on a twig), each its own root.
struct TreeLevel {
  StrandSkeleton strands;
  std::size_t parent_level = 0;            ///< below this level's own number; unused in the first
  std::vector<std::uint32_t> parent;       ///< padded_count() elements, like the next; empty in the first level
  std::vector<std::uint32_t> parent_link;  ///< below links_per_strand of the parent's level
  bool is_turned_by_block = false;
  bool is_leaves = false;            ///< blades to be drawn, not wood
  std::vector<float> base_radius_m;  ///< wood: at the root; leaves: half the width. padded_count() elements
  std::vector<float> tip_radius_m;   ///< wood: at the tip. padded_count() elements

  friend bool operator==(const TreeLevel&, const TreeLevel&) = default;
};

/// The color of a tree's leaves. The stream (pose.fbs) has the same in the same order.
enum class FoliageColor : std::uint8_t {
  kGreen,
  kBlossom,  ///< the pale pink of a cherry in flower
  kAutumn,   ///< yellow to red
  kBare,     ///< no leaves: the strands of leaves are twigs
};
inline constexpr std::array<std::string_view, 4> kFoliageColorNames = {"green", "blossom", "autumn", "bare"};

/// The copies of a tree: its grove. One value per copy in each vector. At most kMaxTreeCopies.
struct TreeCopies {
  std::vector<float> x_m, z_m;  ///< position of the trunk's foot, at the height of the tree's own
  std::vector<float> turn_rad;  ///< clockwise from above, about the foot; the wind bends it like the tree
  std::vector<float> scale;     ///< above 0

  friend bool operator==(const TreeCopies&, const TreeCopies&) = default;
};
inline constexpr std::size_t kMaxTreeCopies = 255;

/// Strands that grow on strands: level 0 stands on the ground. At most kMaxTreeLevels levels.
struct TreeSkeleton {
  std::vector<TreeLevel> levels;
  FoliageColor foliage = FoliageColor::kGreen;
  TreeCopies copies = {};

  friend bool operator==(const TreeSkeleton&, const TreeSkeleton&) = default;
};
inline constexpr std::size_t kMaxTreeLevels = 8;

/// A bend for each strand of each level, in StrandPose's meaning and in the world's directions, on top of the turn that
/// comes from the parent.
struct TreePose {
  std::vector<StrandPose> levels;
};

/// A surface whose points move along their normals, and which can glow: water, a flame. A grid of columns x rows
/// points; point (column, row) is at index row * columns + column. All float vectors have columns * rows elements.
///
/// A closed one is a ring of points in each row, around a body; or several rings, one within another, the outermost
/// first, of columns / shells points each: nested bodies.
struct SurfaceSkeleton {
  std::size_t columns = 0;
  std::size_t rows = 0;
  bool is_closed = false;  ///< the last column of a shell is followed by its first, around a body
  std::size_t shells = 1;  ///< of a closed surface: rings per row, at least 1; columns are a multiple of it
  std::vector<float> rest_x_m, rest_y_m, rest_z_m;
  std::vector<float> normal_x, normal_y, normal_z;  ///< unit vectors
  std::vector<std::uint8_t> ramp_rgba;  ///< 256 colours of 4 bytes (sRGB, straight alpha) for `heat`; empty: no heat
  /// The middle of each row at rest, if poses move whole rows (rows elements); otherwise empty.
  std::vector<float> axis_x_m, axis_z_m;

  bool moves_rows() const { return !axis_x_m.empty(); }
  friend bool operator==(const SurfaceSkeleton&, const SurfaceSkeleton&) = default;
};

/// The displacement of each point along its normal, and the position of its color on the ramp; also the movement of
/// each row in the world, for a body that bends.
///
/// All points of a row move by (row_east_m, -row_drop_m, row_south_m), and the row, which was level, slopes: a point
/// that is x east and z south of the row's middle goes down by row_slope_east x + row_slope_south z. (A body whose rows
/// slope by the tangent of half the angle that its axis leans keeps its thickness across the axis.)
struct SurfacePose {
  std::vector<float> displacement_m;  ///< columns * rows elements
  std::vector<float> heat;            ///< 0 to 1; one per point, or empty without a ramp
  // rows elements each, or empty if rows do not move.
  std::vector<float> row_east_m, row_south_m, row_drop_m;
  std::vector<float> row_slope_east, row_slope_south;
};

/// The kinds of skeleton, and the pose of each, in the same order.
using Skeleton = std::variant<StrandSkeleton, GridSkeleton, TreeSkeleton, SurfaceSkeleton>;
using Pose = std::variant<StrandPose, GridPose, TreePose, SurfacePose>;

}  // namespace yuragi::pose
