#include "viewer/pose_moment.hpp"

#include <algorithm>
#include <cmath>

namespace yuragi {
namespace {

Pose rest_pose(const StrandSkeleton& skeleton) {
  return StrandPose{std::vector<float>(skeleton.padded_count()), std::vector<float>(skeleton.padded_count())};
}

bool has_same_size(const StrandPose& a, const StrandPose& b) {
  return a.bend_east_rad.size() == b.bend_east_rad.size() && a.bend_south_rad.size() == b.bend_south_rad.size();
}

void blend_values(std::span<const float> a, std::span<const float> b, float weight, std::span<float> out) {
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = a[i] + weight * (b[i] - a[i]);
}

void blend_pose(const StrandPose& a, const StrandPose& b, float weight, StrandPose& out) {
  blend_values(a.bend_east_rad, b.bend_east_rad, weight, out.bend_east_rad);
  blend_values(a.bend_south_rad, b.bend_south_rad, weight, out.bend_south_rad);
}

}  // namespace

PoseMoment rest_moment(std::span<const wire::SceneModel> scenes) {
  PoseMoment rest;
  for (const wire::SceneModel& scene : scenes) {
    rest.poses.push_back(std::visit([](const auto& skeleton) { return rest_pose(skeleton); }, scene.skeleton));
  }
  return rest;
}

bool has_same_layout(std::span<const Pose> a, std::span<const Pose> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Pose& left, const Pose& right) {
    if (left.index() != right.index()) return false;
    return std::visit(
        [&](const auto& pose) { return has_same_size(pose, std::get<std::decay_t<decltype(pose)>>(right)); }, left);
  });
}

std::size_t value_bytes(std::span<const Pose> poses) {
  std::size_t bytes = 0;
  for (const Pose& pose : poses) {
    const auto& strands = std::get<StrandPose>(pose);
    bytes += (strands.bend_east_rad.size() + strands.bend_south_rad.size()) * sizeof(float);
  }
  return bytes;
}

void blend(const PoseMoment& a, const PoseMoment& b, double weight, PoseMoment& out) {
  for (std::size_t scene = 0; scene < out.poses.size(); ++scene) {
    std::visit(
        [&](auto& pose) {
          using Kind = std::decay_t<decltype(pose)>;
          blend_pose(std::get<Kind>(a.poses[scene]), std::get<Kind>(b.poses[scene]), static_cast<float>(weight), pose);
        },
        out.poses[scene]);
  }
  out.time_s = std::lerp(a.time_s, b.time_s, weight);
  out.wind.wind = a.wind.wind + weight * (b.wind.wind - a.wind.wind);
  out.wind.live_weight = std::lerp(a.wind.live_weight, b.wind.live_weight, weight);
  out.wind.reading_age_s = std::lerp(a.wind.reading_age_s, b.wind.reading_age_s, weight);
  out.wind.source = weight < 0.5 ? a.wind.source : b.wind.source;
}

}  // namespace yuragi
