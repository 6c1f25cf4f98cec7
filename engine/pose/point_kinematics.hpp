#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/pose/skeleton.hpp"
#include "engine/pose/strand_kinematics.hpp"

namespace yuragi::pose {

/// The points of a cloth or a surface, in the world, in the order of its skeleton's arrays (a cloth's padding
/// included).
///
/// Owns one array: all x, then all y, then all z. Allocates when it is made, never afterwards. Thread-safe: no.
class PointPositions {
 public:
  explicit PointPositions(const GridSkeleton& grid) : PointPositions(grid.rows * grid.stride()) {}
  explicit PointPositions(const SurfaceSkeleton& surface) : PointPositions(surface.rows * surface.columns) {}

  std::size_t size() const noexcept { return size_; }
  std::span<float> data() noexcept { return data_; }
  std::span<const float> data() const noexcept { return data_; }
  std::span<const float> axis_m(std::size_t axis) const noexcept { return data().subspan(axis * size_, size_); }

  JointPosition point(std::size_t index) const noexcept {
    return {data_[index], data_[size_ + index], data_[2 * size_ + index]};
  }

 private:
  explicit PointPositions(std::size_t size) : size_(size), data_(3 * size) {}

  std::size_t size_;
  std::vector<float> data_;
};

/// The one forward kinematics of a cloth: a joint is at its place at rest plus its offset.
///
/// World metres. Owns nothing; skeleton, pose and points must outlive run(). Different jobs may run at the same time.
/// Realtime-safe: yes. One sum a coordinate: the same bits on every machine.
struct GridKinematicsJob {
  const GridSkeleton* skeleton = nullptr;
  const GridPose* pose = nullptr;

  PointPositions* points = nullptr;

  enum class Problem : std::uint8_t {
    kNone,
    kMissingPart,   ///< no skeleton, pose or points
    kSkeletonSize,  ///< an array of the skeleton does not have rows * stride() elements
    kPoseSize,      ///< an array of the pose has not
    kPointsSize,    ///< the points were made for another skeleton
  };
  [[nodiscard]] Problem validate() const noexcept;

  /// Runs the job unless validate() finds a problem; returns the result of validate().
  Problem run() const noexcept;
};

/// The one forward kinematics of a surface: a point is at its place at rest, moved along its normal by its
/// displacement, and then as its row is, where rows are moved (SurfacePose). Otherwise as GridKinematicsJob.
struct SurfaceKinematicsJob {
  const SurfaceSkeleton* skeleton = nullptr;
  const SurfacePose* pose = nullptr;

  PointPositions* points = nullptr;

  using Problem = GridKinematicsJob::Problem;
  [[nodiscard]] Problem validate() const noexcept;
  Problem run() const noexcept;
};

}  // namespace yuragi::pose
