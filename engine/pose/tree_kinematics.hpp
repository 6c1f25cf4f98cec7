#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/pose/skeleton.hpp"
#include "engine/pose/strand_kinematics.hpp"

namespace yuragi {

/// The joints of a tree, in the world, level by level, and what the kinematics needs on the way there.
///
/// Allocates when it is made, never afterwards. Thread-safe: no.
class TreeJoints {
 public:
  explicit TreeJoints(const TreeSkeleton& tree);

  std::size_t level_count() const noexcept { return levels_.size(); }
  JointPositions& level(std::size_t index) noexcept { return levels_[index]; }
  const JointPositions& level(std::size_t index) const noexcept { return levels_[index]; }

 private:
  friend struct TreeKinematicsJob;

  /// How the strands of a level above the first stand now. Of the first, only its turn has elements: it has none.
  struct Stand {
    std::vector<float> root_x_m, root_y_m, root_z_m;
    std::vector<float> rest_x, rest_y, rest_z;
    std::vector<float> curl_x, curl_y, curl_z;
    std::vector<float> turn_w, turn_x, turn_y, turn_z;  ///< a quaternion for each strand or block, in whole blocks
  };

  std::vector<JointPositions> levels_;
  std::vector<Stand> stands_;
};

/// The one forward kinematics of a tree: each level is strands (as StrandKinematicsJob) whose roots, rest directions
/// and curls have gone with the links that they grow from (what that means: TreeLevel in skeleton.hpp).
///
/// The turn of a link is that of its strand's root, followed by the link's share of the strand's bend about up x bend.
/// World metres. Owns nothing; skeleton, pose and joints must outlive run(). Different jobs may run at the same time.
/// Realtime-safe: yes. Every SIMD row computes the same bits. The rest pose gives the skeleton as it stands.
struct TreeKinematicsJob {
  const TreeSkeleton* skeleton = nullptr;
  const TreePose* pose = nullptr;
  std::optional<SimdRow> row = std::nullopt;  ///< unset: the widest that this machine can run

  TreeJoints* joints = nullptr;

  enum class Problem : std::uint8_t {
    kNone,
    kMissingPart,   ///< no skeleton, pose or joints
    kSkeletonSize,  ///< an array of the skeleton has the wrong size, or names a parent that is not there
    kPoseSize,
    kJointsSize,  ///< the joints were made for another skeleton
    kRowNotRunnable,
  };
  [[nodiscard]] Problem validate() const noexcept;

  /// Does the work, if validate() has nothing against it; returns what validate() says.
  Problem run() const noexcept;
};

}  // namespace yuragi
