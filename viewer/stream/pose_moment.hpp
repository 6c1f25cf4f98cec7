#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/wire/wire.hpp"

namespace yuragi::viewer::stream {

/// The content of one moment: the wind, and the pose of each scene.
struct PoseMoment {
  double time_s = 0.0;                                      ///< on the sender's time line
  std::uint64_t tick = 0;                                   ///< of the frame at this moment or before it
  wind::State wind;                                         ///< its `time` is not used
  std::optional<double> view_wind_from_deg = std::nullopt;  ///< for cameras with a wind_angle
  std::vector<pose::Pose> poses;
  std::vector<float> opacities;  ///< one a scene, 0 (hidden) to 1
};

/// The rest pose of each skeleton, in still air, at opacity 1.
PoseMoment rest_moment(std::span<const wire::SceneModel> scenes);

/// Have both the same scenes, of the same kinds and sizes?
bool has_same_layout(std::span<const pose::Pose> a, std::span<const pose::Pose> b);

/// How many bytes of values the poses hold.
std::size_t value_bytes(std::span<const pose::Pose> poses);

/// Makes `out` the moment at `weight` (0: a, 1: b) of the way from `a` to `b`. Poses, opacities and wind are blended as
/// vectors, so that a direction passes through north on its way from 350 to 10 degrees, and never through south. All
/// three have the same layout; `out` may be one of the others. Does not allocate.
void blend(const PoseMoment& a, const PoseMoment& b, double weight, PoseMoment& out);

}  // namespace yuragi::viewer::stream
