#include "viewer/stream/pose_moment.hpp"

#include <algorithm>
#include <cmath>

#include "engine/pose/pose_arrays.hpp"

namespace yuragi::viewer::stream {
PoseMoment rest_moment(std::span<const wire::SceneModel> scenes) {
  PoseMoment rest;
  for (const wire::SceneModel& scene : scenes) rest.poses.push_back(pose::rest_pose(scene.skeleton));
  rest.opacities.assign(scenes.size(), 1.0F);
  return rest;
}

bool has_same_layout(std::span<const pose::Pose> a, std::span<const pose::Pose> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const pose::Pose& left, const pose::Pose& right) {
    const pose::Arrays<const float> lefts(left);
    const pose::Arrays<const float> rights(right);
    return left.index() == right.index() && std::equal(lefts.begin(), lefts.end(), rights.begin(), rights.end(),
                                                       [](auto one, auto other) { return one.size() == other.size(); });
  });
}

std::size_t value_bytes(std::span<const pose::Pose> poses) {
  std::size_t bytes = 0;
  for (const pose::Pose& pose : poses) {
    pose::for_each_array(pose, [&bytes](std::span<const float> values) { bytes += values.size_bytes(); });
  }
  return bytes;
}

void blend(const PoseMoment& a, const PoseMoment& b, double weight, PoseMoment& out) {
  const auto share = static_cast<float>(weight);
  for (std::size_t scene = 0; scene < out.poses.size(); ++scene) {
    const pose::Arrays<const float> from(a.poses[scene]);
    const pose::Arrays<const float> to(b.poses[scene]);
    const pose::Arrays<float> mixed(out.poses[scene]);
    for (std::size_t array = 0; array < mixed.size(); ++array) {
      for (std::size_t i = 0; i < mixed[array].size(); ++i) {
        mixed[array][i] = from[array][i] + share * (to[array][i] - from[array][i]);
      }
    }
  }
  for (std::size_t scene = 0; scene < out.opacities.size(); ++scene) {
    out.opacities[scene] = a.opacities[scene] + share * (b.opacities[scene] - a.opacities[scene]);
  }
  out.tick = weight < 1.0 ? a.tick : b.tick;
  out.time_s = std::lerp(a.time_s, b.time_s, weight);
  out.wind.wind = a.wind.wind + weight * (b.wind.wind - a.wind.wind);
  if (a.view_wind_from_deg && b.view_wind_from_deg) {
    const double turn_deg = std::remainder(*b.view_wind_from_deg - *a.view_wind_from_deg, 360.0);
    out.view_wind_from_deg = *a.view_wind_from_deg + weight * turn_deg;
  } else {
    out.view_wind_from_deg = b.view_wind_from_deg;
  }
  out.wind.live_weight = std::lerp(a.wind.live_weight, b.wind.live_weight, weight);
  out.wind.reading_age_s = std::lerp(a.wind.reading_age_s, b.wind.reading_age_s, weight);
  out.wind.upwind_m = std::lerp(a.wind.upwind_m, b.wind.upwind_m, weight);
  out.wind.to_middle_s = std::lerp(a.wind.to_middle_s, b.wind.to_middle_s, weight);
  out.wind.is_place_configured = weight < 0.5 ? a.wind.is_place_configured : b.wind.is_place_configured;
  out.wind.source = weight < 0.5 ? a.wind.source : b.wind.source;
}

}  // namespace yuragi::viewer::stream
