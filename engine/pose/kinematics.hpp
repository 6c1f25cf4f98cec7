#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <variant>

#include "engine/base/simd_row.hpp"
#include "engine/pose/point_kinematics.hpp"
#include "engine/pose/skeleton.hpp"
#include "engine/pose/strand_kinematics.hpp"
#include "engine/pose/tree_kinematics.hpp"

namespace yuragi::pose {

/// The positions of the joints of a skeleton of any kind: StrandKinematicsJob, GridKinematicsJob, TreeKinematicsJob or
/// SurfaceKinematicsJob, and their outputs.
///
/// The skeleton must outlive this. Allocates when it is made, never afterwards. Thread-safe: no. Realtime-safe: run()
/// and reading.
class Kinematics {
 public:
  explicit Kinematics(const Skeleton& skeleton, std::optional<SimdRow> row = std::nullopt);

  /// Computes all joints, or those of a part of them: parts can run at the same time (small skeletons are completely in
  /// the first). Returns false, and does nothing, if the pose does not fit the skeleton.
  bool run(const Pose& pose, Part part = {}) noexcept;

  /// The joints, in arrays that depend on the kind: JointPositions, PointPositions, TreeJoints.
  using Joints = std::variant<JointPositions, PointPositions, TreeJoints>;
  const Joints& joints() const noexcept { return joints_; }
  Joints& joints() noexcept { return joints_; }

  /// A joint by its number, below node_count(skeleton): strand by strand from root to tip, row by row of a grid or
  /// surface, level by level of a tree.
  JointPosition joint(std::size_t number) const noexcept;

  /// Going on from `seed`, the hash of all joints (pose_hash.hpp), padding included.
  std::uint64_t hash(std::uint64_t seed) const noexcept;

 private:
  const Skeleton* skeleton_;
  std::optional<SimdRow> row_;
  Joints joints_;
};

}  // namespace yuragi::pose
