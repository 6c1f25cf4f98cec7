#pragma once

#include <cstddef>
#include <variant>
#include <vector>

namespace yuragi {

// World: right-handed, x east, y up, z south; metres and radians.
//
// A skeleton is what never changes of a thing that sways; a pose is what moves, in the skeleton's layout. Joint
// positions come from the two by forward kinematics (strand_kinematics.hpp), and nowhere else.

/// Strands are computed in blocks of this many, side by side in SIMD lanes. Arrays are padded to whole blocks.
inline constexpr std::size_t kStrandsPerBlock = 16;

constexpr std::size_t padded_to_blocks(std::size_t strands) {
  return (strands + kStrandsPerBlock - 1) / kStrandsPerBlock * kStrandsPerBlock;
}

/// Many chains of the same number of links: grass, fur.
///
/// At rest a chain leaves its root along `rest` and curls by `rest_curl_rad` from each link to the next toward `curl`.
/// All vectors have padded_to_blocks(strand_count) elements; what is behind strand_count is finite and is not shown.
struct StrandSkeleton {
  std::size_t strand_count = 0;
  std::size_t links_per_strand = 0;
  std::vector<float> root_x_m, root_y_m, root_z_m;
  std::vector<float> rest_x, rest_y, rest_z;  ///< unit vector: direction of the first link at rest
  std::vector<float> curl_x, curl_y, curl_z;  ///< unit vector across `rest`: where the chain curls to
  std::vector<float> rest_curl_rad;           ///< between one link and the next, at rest
  std::vector<float> link_length_m;

  std::size_t padded_count() const { return padded_to_blocks(strand_count); }
};

/// One bend for each strand: the vector (east, south) toward which its tip link is turned, its length the angle in
/// radians. Link i of n (from 1) is turned from its rest direction by i/n of that angle about the horizontal axis
/// across the bend (up x bend), so that the chain makes an arc. (0, 0) is the rest pose. Both vectors have
/// padded_count() elements.
struct StrandPose {
  std::vector<float> bend_east_rad;
  std::vector<float> bend_south_rad;
};

/// The kinds of skeleton, and the pose that goes with each, in the same order.
using Skeleton = std::variant<StrandSkeleton>;
using Pose = std::variant<StrandPose>;

}  // namespace yuragi
