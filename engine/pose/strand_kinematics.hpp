#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/base/part.hpp"
#include "engine/base/simd_row.hpp"
#include "engine/pose/skeleton.hpp"

namespace yuragi::pose {

struct JointPosition {
  float x_m;
  float y_m;
  float z_m;
};

/// The joints of many strands, in the world: the end of each link. (The roots are the skeleton's.)
///
/// Owns one array, in blocks of 16 strands: coordinate `axis` (0 x, 1 y, 2 z) of the joint after link `link` is
/// data()[((block * links + link) * 3 + axis) * 16 + lane], where strand = block * 16 + lane. Also keeps the sine and
/// cosine of each strand's rest curl, which never change. Allocates when it is made, never afterwards. Thread-safe: no.
class JointPositions {
 public:
  explicit JointPositions(const StrandSkeleton& skeleton);

  std::size_t links_per_strand() const noexcept { return links_; }
  std::span<float> data() noexcept { return data_; }
  std::span<const float> data() const noexcept { return data_; }

  /// `strand` below the padded count, `link` below links_per_strand().
  JointPosition joint(std::size_t strand, std::size_t link) const noexcept {
    const std::size_t block = strand / kStrandsPerBlock;
    const std::size_t lane = strand % kStrandsPerBlock;
    const float* at = data_.data() + (block * links_ + link) * 3 * kStrandsPerBlock + lane;
    return {at[0], at[kStrandsPerBlock], at[2 * kStrandsPerBlock]};
  }

 private:
  friend struct StrandKinematicsJob;
  friend struct TreeKinematicsJob;

  std::size_t links_;
  std::vector<float> data_;
  std::vector<float> curl_sin_, curl_versine_;  ///< of each strand's curl between links; the versine is 1 - cosine
};

/// The only forward kinematics of strands: the joints of a skeleton in a pose (their meaning: skeleton.hpp).
///
/// Link i of n (from 1) is its rest direction, turned by i/n of the bend about the horizontal axis up x bend
/// (Rodrigues). An upright link bent by theta toward (sin phi, -cos phi) then points along (sin theta sin phi, cos
/// theta, -sin theta cos phi): the paper's tip formula (Chiba, section 3.1) read as a direction, because a link keeps
/// its length in any wind (engine/METHOD.md M13, D1); the paper's z is north, ours south. Links keep their length to
/// 1e-5 of it, within the precision of a float at the joint's place. The bend (0, 0) gives the rest pose; every finite
/// bend gives finite joints: bends are limited to pi, and curls to 32 rad.
///
/// World metres. Owns nothing; skeleton, pose and joints must outlive run(). Different jobs may run at the same time.
/// Realtime-safe: yes. Every SIMD row computes the same bits. Cost: about 0.6 ns a joint of strands of ten links
/// (x86-64-v3).
struct StrandKinematicsJob {
  const StrandSkeleton* skeleton = nullptr;
  const StrandPose* pose = nullptr;
  std::optional<SimdRow> row = std::nullopt;  ///< unset: the widest that this machine can run
  Part part = {};                             ///< of the blocks: parts can run at the same time

  JointPositions* joints = nullptr;

  enum class Problem : std::uint8_t {
    kNone,
    kMissingPart,   ///< no skeleton, pose or joints
    kSkeletonSize,  ///< an array of the skeleton does not have padded_count() elements, or there are no links
    kPoseSize,      ///< an array of the pose does not have padded_count() elements
    kJointsSize,    ///< the joints were made for another skeleton
    kRowNotRunnable,
  };
  [[nodiscard]] Problem validate() const noexcept;

  /// Runs the job unless validate() finds a problem; returns the result of validate().
  Problem run() const noexcept;
};

}  // namespace yuragi::pose
