#include "engine/pose/kinematics.hpp"

#include "engine/pose/pose_hash.hpp"

namespace yuragi::pose {
namespace {

Kinematics::Joints make_joints(const Skeleton& skeleton) {
  if (const auto* strands = std::get_if<StrandSkeleton>(&skeleton)) return JointPositions(*strands);
  if (const auto* grid = std::get_if<GridSkeleton>(&skeleton)) return PointPositions(*grid);
  if (const auto* tree = std::get_if<TreeSkeleton>(&skeleton)) return TreeJoints(*tree);
  return PointPositions(std::get<SurfaceSkeleton>(skeleton));
}

JointPosition joint_of_strands(const JointPositions& joints, std::size_t number) noexcept {
  return joints.joint(number / joints.links_per_strand(), number % joints.links_per_strand());
}

}  // namespace

Kinematics::Kinematics(const Skeleton& skeleton, std::optional<SimdRow> row)
    : skeleton_(&skeleton), row_(row), joints_(make_joints(skeleton)) {}

bool Kinematics::run(const Pose& pose, Part part) noexcept {
  if (const auto* strands = std::get_if<StrandSkeleton>(skeleton_)) {
    const StrandKinematicsJob job{.skeleton = strands,
                                  .pose = std::get_if<StrandPose>(&pose),
                                  .row = row_,
                                  .part = part,
                                  .joints = std::get_if<JointPositions>(&joints_)};
    return job.run() == StrandKinematicsJob::Problem::kNone;
  }
  if (part.index > 0) return true;
  if (const auto* grid = std::get_if<GridSkeleton>(skeleton_)) {
    const GridKinematicsJob job{
        .skeleton = grid, .pose = std::get_if<GridPose>(&pose), .points = std::get_if<PointPositions>(&joints_)};
    return job.run() == GridKinematicsJob::Problem::kNone;
  }
  if (const auto* tree = std::get_if<TreeSkeleton>(skeleton_)) {
    const TreeKinematicsJob job{.skeleton = tree,
                                .pose = std::get_if<TreePose>(&pose),
                                .row = row_,
                                .joints = std::get_if<TreeJoints>(&joints_)};
    return job.run() == TreeKinematicsJob::Problem::kNone;
  }
  const SurfaceKinematicsJob job{.skeleton = std::get_if<SurfaceSkeleton>(skeleton_),
                                 .pose = std::get_if<SurfacePose>(&pose),
                                 .points = std::get_if<PointPositions>(&joints_)};
  return job.run() == SurfaceKinematicsJob::Problem::kNone;
}

JointPosition Kinematics::joint(std::size_t number) const noexcept {
  if (const auto* joints = std::get_if<JointPositions>(&joints_)) return joint_of_strands(*joints, number);
  if (const auto* points = std::get_if<PointPositions>(&joints_)) {
    const auto* grid = std::get_if<GridSkeleton>(skeleton_);  // whose rows are padded
    return points->point(grid == nullptr ? number : number / grid->columns * grid->stride() + number % grid->columns);
  }
  const TreeJoints& tree = *std::get_if<TreeJoints>(&joints_);
  const auto& levels = std::get_if<TreeSkeleton>(skeleton_)->levels;
  for (std::size_t level = 0; level + 1 < levels.size(); ++level) {
    const std::size_t count = levels[level].strands.strand_count * levels[level].strands.links_per_strand;
    if (number < count) return joint_of_strands(tree.level(level), number);
    number -= count;
  }
  return joint_of_strands(tree.level(levels.size() - 1), number);
}

std::uint64_t Kinematics::hash(std::uint64_t seed) const noexcept {
  if (const auto* joints = std::get_if<JointPositions>(&joints_)) return pose_hash(seed, joints->data());
  if (const auto* points = std::get_if<PointPositions>(&joints_)) return pose_hash(seed, points->data());
  std::uint64_t hash = seed;
  const TreeJoints& tree = *std::get_if<TreeJoints>(&joints_);
  for (std::size_t level = 0; level < tree.level_count(); ++level) hash = pose_hash(hash, tree.level(level).data());
  return hash;
}

}  // namespace yuragi::pose
