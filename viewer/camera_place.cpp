#include "viewer/camera_place.hpp"

#include <cmath>
#include <numbers>

#include <glm/trigonometric.hpp>

namespace yuragi::viewer {
namespace {

constexpr double kUsualDistance_m = 10.0;

}  // namespace

meshes::CameraPlace place_of(const look::Camera& camera, const std::optional<meshes::Bounds>& scene, double aspect,
                             double utc_s) {
  meshes::CameraPlace place;
  place.target_m = {camera.target_x_m, camera.target_y_m, camera.target_z_m};
  if (scene) place.target_m += glm::dvec3(scene->low_m + scene->high_m) / 2.0;
  place.pitch_deg = camera.pitch_deg;
  place.field_of_view_deg = camera.fov_deg;

  const double wave = std::sin(2.0 * std::numbers::pi * std::fmod(utc_s / camera.period_s, 1.0));
  const double turned_deg = 360.0 * std::fmod(utc_s * (camera.turn_deg_min / 60.0 / 360.0), 1.0);
  place.heading_deg = camera.heading_deg + turned_deg + camera.sway_deg * wave;
  place.distance_m = kUsualDistance_m;
  if (scene) place.distance_m = distance_to_see(*scene, place, aspect);
  if (camera.distance_m) place.distance_m = *camera.distance_m;
  place.distance_m += camera.dolly_m * wave;

  const double heading = glm::radians(place.heading_deg);
  place.target_m += glm::dvec3(std::cos(heading), 0.0, std::sin(heading)) * (camera.track_m * wave);
  if (camera.pan_deg != 0.0) {
    // The target goes around the eye.
    const glm::dvec3 eye_m = eye_of(place);
    place.heading_deg += camera.pan_deg * wave;
    place.target_m += eye_m - eye_of(place);
  }
  return place;
}

}  // namespace yuragi::viewer
