#include "viewer/meshes/orbit_camera.hpp"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

namespace yuragi::viewer::meshes {
namespace {

constexpr double kOrbit_deg = 180.0;  // for a drag over the picture's height
constexpr double kZoomStep = 0.88;    // factor on the distance per notch
constexpr double kGlide_s = 0.08;     // the time constant with which it follows a drag
constexpr double kTurning_deg_s = 2.0;
constexpr double kMaxTarget_m = 500.0;  // from the origin
constexpr double kAcrossPitch_deg = 6.0;
constexpr double kFieldHeights = 5.0;       // wider than this many heights: something to look across
constexpr double kAcrossHeights = 1.05;     // height of the eye, in heights of the field
constexpr double kFromCorner_deg = 32.0;    // angle from which a broad side is viewed, if the wind allows it
constexpr double kMaxAlongWind_deg = 30.0;  // maximum deviation from straight across the wind
constexpr double kFlatHeights = 0.2;        // a flat thing: height relative to its width
constexpr double kFlatPitch_deg = 7.0;
constexpr double kFlatShown = 0.6;  // of its width
constexpr double kEyeHeights = 0.45;
constexpr double kSittingEye_m = 0.5;
constexpr double kStandingEye_m = 1.5;
constexpr double kLowestHorizon = 0.55;  // distance from the picture's middle to its lower side
constexpr double kFilled = 0.95;         // of the picture
constexpr double kUsualAspect = 16.0 / 9.0;
constexpr double kFar_m = 2000.0;
constexpr double kMinFieldOfView_deg = 2.0;
constexpr double kMaxFieldOfView_deg = 120.0;
constexpr double kShorePitch_deg = 11.0;
constexpr double kShoreEye_m = 0.85;
constexpr float kFromShore = 0.1F;
constexpr double kBesidePitch_deg = 5.0;
constexpr double kBesideTurn_deg = 20.0;
constexpr double kBeside = 0.45;        // of half the depth, from the side
constexpr double kBesideTarget = 0.66;  // of the height

glm::dvec3 direction(const CameraPlace& place) {
  const double heading = glm::radians(place.heading_deg);
  const double pitch = glm::radians(place.pitch_deg);
  return {std::sin(heading) * std::cos(pitch), -std::sin(pitch), -std::cos(heading) * std::cos(pitch)};
}

double finite_or(double value, double fallback) {
  return std::isfinite(value) ? value : fallback;
}

CameraPlace limited(const CameraPlace& place) {
  CameraPlace to = place;
  to.heading_deg = finite_or(place.heading_deg, 0.0);
  to.distance_m =
      std::clamp(finite_or(place.distance_m, 5.0), OrbitCamera::kMinDistance_m, OrbitCamera::kMaxDistance_m);
  for (int axis = 0; axis < 3; ++axis) {
    to.target_m[axis] = std::clamp(finite_or(place.target_m[axis], 0.0), axis == 1 ? 0.0 : -kMaxTarget_m, kMaxTarget_m);
  }
  to.field_of_view_deg = std::clamp(finite_or(place.field_of_view_deg, 40.0), kMinFieldOfView_deg, kMaxFieldOfView_deg);
  // The maximum pitch that keeps the eye above the ground.
  const double sine = std::clamp((OrbitCamera::kMinEye_m - to.target_m.y) / to.distance_m, -1.0, 1.0);
  to.pitch_deg =
      std::clamp(finite_or(place.pitch_deg, 10.0), std::max(OrbitCamera::kMinPitch_deg, glm::degrees(std::asin(sine))),
                 OrbitCamera::kMaxPitch_deg);
  return to;
}

}  // namespace

glm::dvec3 eye_of(const CameraPlace& place) {
  return place.target_m - direction(place) * place.distance_m;
}

double tangent_up(double field_of_view_deg, double aspect) {
  return std::tan(glm::radians(field_of_view_deg) / 2.0) * std::sqrt(kUsualAspect / aspect);
}

void OrbitCamera::frame(const CameraPlace& place) {
  home_ = wanted_ = place_ = limited(place);
}

void OrbitCamera::move_home(const CameraPlace& place) {
  CameraPlace home = home_;
  if (is_turning_) home.heading_deg = wanted_.heading_deg;
  const bool is_home = wanted_ == home;
  const double turned_deg = home.heading_deg - home_.heading_deg;
  home_ = limited(place);
  if (!is_home) return;
  wanted_ = home_;
  wanted_.heading_deg += turned_deg;
  place_ = wanted_;
}

void OrbitCamera::go_to(const CameraPlace& place) {
  wanted_ = place_ = limited(place);
}

void OrbitCamera::orbit(double right, double down) {
  wanted_.heading_deg -= right * kOrbit_deg;
  wanted_.pitch_deg += down * kOrbit_deg;
  wanted_ = limited(wanted_);
}

void OrbitCamera::pan(double right, double down, double aspect) {
  // Keeps the point of the target's plane under the pointer: the picture's height in metres at the target.
  const double height_m = 2.0 * wanted_.distance_m * tangent_up(wanted_.field_of_view_deg, aspect);
  const double heading = glm::radians(wanted_.heading_deg);
  const glm::dvec3 to_right(std::cos(heading), 0.0, std::sin(heading));
  const glm::dvec3 forward(std::sin(heading), 0.0, -std::cos(heading));
  wanted_.target_m += (-right * to_right + down * forward) * height_m;
  wanted_ = limited(wanted_);
}

void OrbitCamera::zoom(double notches) {
  wanted_.distance_m *= std::pow(kZoomStep, std::clamp(notches, -20.0, 20.0));
  wanted_ = limited(wanted_);
}

void OrbitCamera::keep_away(double distance_m) {
  if (place_.distance_m >= distance_m) return;
  place_.distance_m = distance_m;
  wanted_.distance_m = std::max(wanted_.distance_m, distance_m);
  place_ = limited(place_);
  wanted_ = limited(wanted_);
}

void OrbitCamera::advance(double dt_s) {
  if (is_turning_) wanted_.heading_deg += kTurning_deg_s * dt_s;
  const double share = 1.0 - std::exp(-std::max(0.0, dt_s) / kGlide_s);
  place_.target_m += share * (wanted_.target_m - place_.target_m);
  place_.heading_deg += share * (wanted_.heading_deg - place_.heading_deg);
  place_.pitch_deg += share * (wanted_.pitch_deg - place_.pitch_deg);
  place_.distance_m += share * (wanted_.distance_m - place_.distance_m);
  place_.field_of_view_deg += share * (wanted_.field_of_view_deg - place_.field_of_view_deg);
}

glm::mat4 OrbitCamera::view() const {
  return glm::mat4(glm::lookAt(eye_m(), place_.target_m, glm::dvec3(0.0, 1.0, 0.0)));
}

Frustum OrbitCamera::frustum(double aspect) const {
  if (frustum_) return *frustum_;
  const double up = tangent_up(place_.field_of_view_deg, aspect);
  return {.left = -aspect * up, .right = aspect * up, .bottom = -up, .top = up};
}

glm::mat4 OrbitCamera::projection(double aspect) const {
  const double near_m = std::clamp(0.02 * place_.distance_m, 0.01, 1.0);
  if (frustum_) return glm::mat4(projection_of(*frustum_, near_m, kFar_m));
  const double up_rad = 2.0 * std::atan(tangent_up(place_.field_of_view_deg, aspect));
  return glm::mat4(glm::perspective(up_rad, aspect, near_m, kFar_m));
}

double heading_across(double preferred_deg, double broadside_deg, double wind_from_deg) {
  double best_deg = preferred_deg;
  double least_turn_deg = 360.0;
  for (const double side_deg : {90.0, -90.0}) {
    const double across_deg = wind_from_deg + side_deg;
    const double off_deg = std::remainder(preferred_deg - across_deg, 360.0);
    const double heading_deg = across_deg + std::clamp(off_deg, -kMaxAlongWind_deg, kMaxAlongWind_deg);
    const double turn_deg = std::abs(std::remainder(heading_deg - broadside_deg, 360.0));
    if (turn_deg >= least_turn_deg) continue;
    least_turn_deg = turn_deg;
    best_deg = heading_deg;
  }
  return std::fmod(best_deg + 720.0, 360.0);
}

CameraPlace place_across(const Bounds& bounds, double wind_from_deg) {
  const glm::dvec3 low(bounds.low_m);
  const glm::dvec3 high(bounds.high_m);
  const double width_m = std::max(high.x - low.x, 0.1);
  const double depth_m = std::max(high.z - low.z, 0.1);
  const double height_m = std::max(high.y - low.y, 0.05);
  const double diagonal_m = std::hypot(width_m, depth_m);

  CameraPlace place;
  const double diagonal_deg = 180.0 + glm::degrees(std::atan2(width_m, depth_m));
  place.heading_deg = heading_across(diagonal_deg, diagonal_deg, wind_from_deg);
  place.pitch_deg = kAcrossPitch_deg;
  if (diagonal_m < kFieldHeights * height_m) {
    // Hardly wider than high: all of it is shown, from outside.
    place.target_m = {(low.x + high.x) / 2, low.y + 0.5 * height_m, (low.z + high.z) / 2};
    place.distance_m = 0.6 * diagonal_m + 2.0 * height_m;
    return limited(place);
  }

  // Just inside the near edge, over the middle: the streamed blades then extend as far as possible.
  const double eye_height_m = kAcrossHeights * height_m;
  place.distance_m = std::min(0.45 * diagonal_m, 0.75 * eye_height_m / std::sin(glm::radians(kAcrossPitch_deg)));
  const double heading = glm::radians(place.heading_deg);
  const double back_m = std::min(0.44 * width_m / std::max(std::abs(std::sin(heading)), 1e-6),
                                 0.44 * depth_m / std::max(std::abs(std::cos(heading)), 1e-6));
  const glm::dvec3 eye_m((low.x + high.x) / 2 - std::sin(heading) * back_m, low.y + eye_height_m,
                         (low.z + high.z) / 2 + std::cos(heading) * back_m);
  place.target_m = eye_m + direction(place) * place.distance_m;
  return limited(place);
}

double distance_to_see(const Bounds& bounds, const CameraPlace& place, double aspect) {
  const glm::dvec3 half_m = glm::dvec3(bounds.high_m - bounds.low_m) / 2.0;
  const glm::dvec3 forward = direction(place);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0.0, 1.0, 0.0)));
  const glm::dvec3 up = glm::cross(right, forward);
  const double tan_up = kFilled * tangent_up(place.field_of_view_deg, aspect);
  double distance_m = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 sign((corner & 1) * 2 - 1, (corner >> 1 & 1) * 2 - 1, (corner >> 2 & 1) * 2 - 1);
    const glm::dvec3 from_middle = sign * half_m;
    const double across = std::abs(glm::dot(from_middle, right)) / (tan_up * aspect);
    const double upright = std::abs(glm::dot(from_middle, up)) / tan_up;
    distance_m = std::max(distance_m, std::max(across, upright) - glm::dot(from_middle, forward));
  }
  return distance_m;
}

CameraPlace place_around(const Bounds& bounds, double aspect, double wind_from_deg) {
  const glm::dvec3 size_m = bounds.high_m - bounds.low_m;

  // Toward the broad side: looking south-south-west, or west-south-west, as far as the wind allows it.
  CameraPlace place;
  place.heading_deg = size_m.x >= size_m.z ? heading_across(180.0 + kFromCorner_deg, 180.0, wind_from_deg)
                                           : heading_across(270.0 - kFromCorner_deg, 270.0, wind_from_deg);
  place.target_m = glm::dvec3(bounds.low_m + bounds.high_m) / 2.0;
  if (size_m.y < kFlatHeights * std::hypot(size_m.x, size_m.z)) {
    // From its edge, so that it extends beyond the picture's sides; in an upright picture from no farther.
    place.pitch_deg = kFlatPitch_deg;
    place.distance_m = kFlatShown * distance_to_see(bounds, place, std::max(aspect, kUsualAspect));
    return limited(place);
  }

  // From the height of a standing or sitting person, against the sky; with the horizon well inside the picture.
  const double eye_height_m = std::clamp(kEyeHeights * size_m.y, kSittingEye_m, kStandingEye_m);
  const double up_deg = glm::degrees(std::atan(tangent_up(place.field_of_view_deg, aspect)));
  place.pitch_deg = 0.0;
  for (int round = 0; round < 4; ++round) {
    place.distance_m = distance_to_see(bounds, place, aspect);
    const double sine = std::clamp((eye_height_m - place.target_m.y) / place.distance_m, -1.0, 1.0);
    place.pitch_deg = std::max(glm::degrees(std::asin(sine)), -kLowestHorizon * up_deg);
  }
  place.distance_m = distance_to_see(bounds, place, aspect);
  return limited(place);
}

CameraPlace place_on_shore(const Shore& shore, double wind_from_deg) {
  // Across the longer side, not from the side of the evening sun, as far as the wind allows it.
  const bool is_along = shore.half_m().x >= shore.half_m().y;
  glm::dvec2 ahead(is_along ? shore.along() : shore.across());
  if (ahead.x - ahead.y > 0.0) ahead = -ahead;  // toward the south-west
  const double preferred_deg = glm::degrees(std::atan2(ahead.x, -ahead.y));
  const double heading_deg = heading_across(preferred_deg, preferred_deg, wind_from_deg);
  ahead = {std::sin(glm::radians(heading_deg)), -std::cos(glm::radians(heading_deg))};
  const glm::dvec2 half_m(shore.half_m());
  const double bearing_rad = std::atan2(-glm::dot(ahead, glm::dvec2(shore.across())) / half_m.y,
                                        -glm::dot(ahead, glm::dvec2(shore.along())) / half_m.x);
  const glm::dvec2 eye_m(shore.at(static_cast<float>(bearing_rad), kFromShore * shore.scale()));
  const double height_m = kShoreEye_m * static_cast<double>(shore.scale());
  CameraPlace place;
  place.heading_deg = heading_deg;
  place.pitch_deg = kShorePitch_deg;
  place.distance_m = 0.8 * height_m / std::sin(glm::radians(kShorePitch_deg));
  place.target_m = glm::dvec3(eye_m.x, height_m, eye_m.y) + direction(place) * place.distance_m;
  return limited(place);
}

CameraPlace place_beside(const Bounds& bounds, double wind_from_deg) {
  const glm::dvec3 size_m = glm::dvec3(bounds.high_m) - glm::dvec3(bounds.low_m);
  const bool is_long_in_x = size_m.x >= size_m.z;
  const double half_depth_m = 0.5 * std::min(size_m.x, size_m.z);
  const double broadside_deg = is_long_in_x ? 180.0 : 270.0;
  CameraPlace place;
  place.heading_deg = heading_across(broadside_deg - kBesideTurn_deg, broadside_deg, wind_from_deg);
  place.pitch_deg = kBesidePitch_deg;
  place.distance_m = kBeside * half_depth_m + 0.9 * size_m.y;
  place.target_m = glm::dvec3(bounds.low_m) + 0.5 * size_m;
  place.target_m.y = static_cast<double>(bounds.low_m.y) + kBesideTarget * size_m.y;
  return limited(place);
}

}  // namespace yuragi::viewer::meshes
