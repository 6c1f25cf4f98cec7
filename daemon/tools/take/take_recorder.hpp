#pragma once

#include <cstddef>
#include <ostream>
#include <string>
#include <vector>

#include "daemon/tools/take/take_mesh.hpp"
#include "engine/base/result.hpp"
#include "engine/pose/kinematics.hpp"
#include "engine/pose/skeleton.hpp"

namespace yuragi::daemon::tools::take {

/// No more joints fit the 16 bits by which glTF numbers those of a vertex.
inline constexpr std::size_t kMaxJoints = 65535;

/// The places of joints in all pictures that a take has room for: 12 bytes each, kept in memory until it is written.
inline constexpr double kMaxPlaces = 80e6;

/// Checks how large a take becomes, of at least one joint; fails with what to do if it has more than kMaxPlaces. Call
/// it before any picture is made, if their number is known.
Result<void, Failure> checked_size(std::size_t joints, double pictures);

/// One scene's motion as a file for 3D programs: glTF 2.0 in its binary form (Khronos Group, ISO/IEC 12113:2022), a
/// skinned mesh in which each joint is a node with its place over time. Metres, y up, as here; x east, z south. What
/// does not move has no curve. Neither normals nor colours: a person who opens it gives it a material.
class Recorder {
 public:
  /// `skeleton` must outlive this, and have at most kMaxJoints with that `every` (every_within()).
  Recorder(const pose::Skeleton& skeleton, std::string name, std::size_t every, double fps);

  /// The next picture. False if the pose does not fit the skeleton.
  bool add(const pose::Pose& pose);

  std::size_t frames() const noexcept { return frames_; }
  std::size_t joints() const noexcept { return mesh_.joints.size(); }

  /// Fails if there is no picture, or the stream does not take it all.
  Result<void, Failure> write_glb(std::ostream& out) const;

 private:
  std::string name_;
  double fps_;
  Mesh mesh_;
  pose::Kinematics kinematics_;
  std::vector<float> places_m_;  ///< x, y, z of each joint, picture after picture
  std::size_t frames_ = 0;
};

}  // namespace yuragi::daemon::tools::take
