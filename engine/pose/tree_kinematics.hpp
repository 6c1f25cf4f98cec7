#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/pose/skeleton.hpp"
#include "engine/pose/strand_kinematics.hpp"

namespace yuragi::pose {

struct StrandKernelArguments;
struct TreeKernelArguments;
struct TurnArrays;

/// The joints of a tree, in the world, level by level, and the intermediate values of the kinematics.
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

  /// The turns of a level's roots: a quaternion for each strand or block, in whole blocks.
  struct Turns {
    std::vector<float> w, x, y, z;
  };

  std::vector<JointPositions> levels_;
  std::vector<Turns> turns_;
  std::vector<float> standing_;  ///< the present state of the strands of some blocks: nine arrays
};

/// The only forward kinematics of a tree: each level consists of strands (as in StrandKinematicsJob) whose roots, rest
/// directions and curls have moved with the links from which they grow (see TreeLevel in skeleton.hpp).
///
/// The turn of a link is that of its strand's root, followed by the link's share of the strand's bend about up x bend.
/// World metres. Owns nothing; skeleton, pose and joints must outlive run(). Different jobs may run at the same time.
/// Realtime-safe: yes. Every SIMD row computes the same bits. The rest pose gives the skeleton unchanged.
struct TreeKinematicsJob {
  const TreeSkeleton* skeleton = nullptr;
  const TreePose* pose = nullptr;
  std::optional<SimdRow> row = std::nullopt;  ///< unset: the widest that this machine can run

  TreeJoints* joints = nullptr;

  enum class Problem : std::uint8_t {
    kNone,
    kMissingPart,   ///< no skeleton, pose or joints
    kSkeletonSize,  ///< an array of the skeleton has the wrong size, or names a parent that does not exist
    kPoseSize,
    kJointsSize,  ///< the joints were made for another skeleton
    kRowNotRunnable,
  };
  [[nodiscard]] Problem validate() const noexcept;

  /// Runs the job unless validate() finds a problem; returns the result of validate().
  Problem run() const noexcept;

 private:
  // The arguments of the kernels of a level.
  StrandKernelArguments strands_of(std::size_t level) const noexcept;
  TurnArrays turns_of(std::size_t level) const noexcept;
  TreeKernelArguments carried_from_parents(std::size_t level) const noexcept;
};

}  // namespace yuragi::pose
