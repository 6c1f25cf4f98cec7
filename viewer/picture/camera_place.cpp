#include "viewer/picture/camera_place.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/trigonometric.hpp>

namespace yuragi::viewer::picture {
namespace {

constexpr double kUsualDistance_m = 10.0;
constexpr double kAway_m = 0.5;  // distance of an eye from an obstacle
constexpr int kHeadings = 72;

/// The distance at which the whole scene is in the picture from every side.
double distance_from_all_sides_m(const meshes::Bounds& scene, meshes::CameraPlace place, double aspect) {
  double distance_m = 0.0;
  for (int heading = 0; heading < kHeadings; ++heading) {
    place.heading_deg = heading * (360.0 / kHeadings);
    distance_m = std::max(distance_m, distance_to_see(scene, place, aspect));
  }
  return distance_m;
}

}  // namespace

double clear_distance_m(const meshes::CameraPlace& place, double distance_m,
                        std::span<const meshes::Bounds> obstacles) {
  const double level = std::max(std::cos(glm::radians(place.pitch_deg)), 1e-3);
  const double rise = std::sin(glm::radians(place.pitch_deg));
  for (std::size_t round = 0; round <= obstacles.size(); ++round) {
    const double before_m = distance_m;
    for (const meshes::Bounds& box : obstacles) {
      // The eye's circle meets the box at distances between these.
      const glm::dvec3 low = glm::dvec3(box.low_m) - place.target_m;
      const glm::dvec3 high = glm::dvec3(box.high_m) - place.target_m;
      const double near_m = std::hypot(std::max({low.x, -high.x, 0.0}), std::max({low.z, -high.z, 0.0}));
      const double far_m =
          std::hypot(std::max(std::abs(low.x), std::abs(high.x)), std::max(std::abs(low.z), std::abs(high.z)));
      const double from_m = (near_m - kAway_m) / level;
      const double to_m = (far_m + kAway_m) / level;
      if (distance_m <= from_m || distance_m >= to_m) continue;
      const double eye_m = rise * distance_m;  // above the target
      if (eye_m > high.y + kAway_m || eye_m < low.y - kAway_m) continue;
      distance_m = to_m;
    }
    if (distance_m == before_m) break;
  }
  return distance_m;
}

meshes::CameraPlace place_of(const look::Camera& camera, const std::optional<meshes::Bounds>& scene, double aspect,
                             double utc_s, std::optional<double> view_wind_from_deg,
                             std::span<const meshes::Bounds> obstacles) {
  meshes::CameraPlace place;
  place.target_m = {camera.target_x_m, camera.target_y_m, camera.target_z_m};
  if (scene) place.target_m += glm::dvec3(scene->low_m + scene->high_m) / 2.0;
  place.pitch_deg = camera.pitch_deg;
  place.field_of_view_deg = camera.fov_deg;

  const double wave = std::sin(2.0 * std::numbers::pi * std::fmod(utc_s / camera.period_s, 1.0));
  const double turned_deg = 360.0 * std::fmod(utc_s * (camera.turn_deg_min / 60.0 / 360.0), 1.0);
  const bool follows_wind = camera.wind_angle_deg && view_wind_from_deg;
  const double heading_deg = follows_wind ? *view_wind_from_deg + *camera.wind_angle_deg : camera.heading_deg;
  place.heading_deg = heading_deg + turned_deg + camera.sway_deg * wave;
  place.distance_m = kUsualDistance_m;
  if (camera.distance_m) {
    place.distance_m = *camera.distance_m;
  } else if (scene) {
    place.distance_m =
        follows_wind ? distance_from_all_sides_m(*scene, place, aspect) : distance_to_see(*scene, place, aspect);
  }
  if (follows_wind) place.distance_m = clear_distance_m(place, place.distance_m, obstacles);
  place.distance_m += camera.dolly_m * wave;

  const double heading = glm::radians(place.heading_deg);
  place.target_m += glm::dvec3(std::cos(heading), 0.0, std::sin(heading)) * (camera.track_m * wave);
  if (camera.pan_deg != 0.0) {
    // The target moves around the eye.
    const glm::dvec3 eye_m = eye_of(place);
    place.heading_deg += camera.pan_deg * wave;
    place.target_m += eye_m - eye_of(place);
  }
  return place;
}

}  // namespace yuragi::viewer::picture
