#include "viewer/picture/camera_place.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <gtest/gtest.h>

namespace yuragi::viewer::picture {
namespace {

constexpr double kAspect = 16.0 / 9.0;
constexpr double kNow_s = 1'800'000'000.0;  // 120 s have passed a whole number of times

meshes::CameraPlace still(const look::Camera& camera, double utc_s = kNow_s) {
  return place_of(camera, std::nullopt, kAspect, utc_s);
}

TEST(CameraPlace, IsWhatTheConfigurationSays) {
  const meshes::CameraPlace place = still({.target_x_m = 1.0,
                                           .target_y_m = 2.0,
                                           .target_z_m = 3.0,
                                           .heading_deg = 90.0,
                                           .pitch_deg = 5.0,
                                           .distance_m = 12.0,
                                           .fov_deg = 25.0});
  EXPECT_EQ(place.target_m, glm::dvec3(1.0, 2.0, 3.0));
  EXPECT_EQ(place.heading_deg, 90.0);
  EXPECT_EQ(place.pitch_deg, 5.0);
  EXPECT_EQ(place.distance_m, 12.0);
  EXPECT_EQ(place.field_of_view_deg, 25.0);
  EXPECT_EQ(still({}).distance_m, 10.0);
}

TEST(CameraPlace, SeesAllOfItsSceneInEveryPicture) {
  const meshes::Bounds box{{3.0F, 0.0F, -7.0F}, {9.0F, 4.0F, -5.0F}};
  for (const double aspect : {9.0 / 16.0, kAspect, 6.0}) {
    const meshes::CameraPlace place = place_of({.target_y_m = 0.5}, box, aspect, kNow_s);
    EXPECT_EQ(place.target_m, glm::dvec3(6.0, 2.5, -6.0)) << "the middle, and half a metre above";
    EXPECT_NEAR(place.distance_m, distance_to_see(box, place, aspect), 1e-9);
  }
  EXPECT_EQ(place_of({.distance_m = 3.0}, box, kAspect, kNow_s).distance_m, 3.0);
}

TEST(CameraPlace, GoesForthAndBackByTheClock) {
  const look::Camera camera{
      .heading_deg = 30.0, .distance_m = 20.0, .sway_deg = 8.0, .dolly_m = 4.0, .period_s = 120.0};
  EXPECT_NEAR(still(camera).heading_deg, 30.0, 1e-6);
  EXPECT_NEAR(still(camera, kNow_s + 30.0).heading_deg, 38.0, 1e-6);
  EXPECT_NEAR(still(camera, kNow_s + 30.0).distance_m, 24.0, 1e-6);
  EXPECT_NEAR(still(camera, kNow_s + 90.0).heading_deg, 22.0, 1e-6);
  EXPECT_NEAR(still(camera, kNow_s + 90.0).distance_m, 16.0, 1e-6);
  EXPECT_NEAR(still(camera, kNow_s + 120.0).heading_deg, 30.0, 1e-6);
}

TEST(CameraPlace, TurnsForEver) {
  const look::Camera camera{.heading_deg = 30.0, .turn_deg_min = 6.0};
  const double begin_deg = still(camera).heading_deg;
  EXPECT_NEAR(still(camera, kNow_s + 60.0).heading_deg - begin_deg, 6.0, 1e-5);
}

TEST(CameraPlace, PansWhileTheEyeStands) {
  const look::Camera camera{.heading_deg = 30.0, .pitch_deg = 4.0, .distance_m = 20.0, .pan_deg = 25.0};
  const meshes::CameraPlace middle = still(camera);
  const meshes::CameraPlace side = still(camera, kNow_s + 30.0);
  EXPECT_NEAR(side.heading_deg, 55.0, 1e-6);
  EXPECT_LT(glm::length(eye_of(side) - eye_of(middle)), 1e-6);
  EXPECT_GT(glm::length(side.target_m - middle.target_m), 5.0);
}

TEST(CameraPlace, TracksToItsRight) {
  const look::Camera camera{.heading_deg = 0.0, .distance_m = 20.0, .track_m = 3.0};  // looks north: right is east
  const meshes::CameraPlace middle = still(camera);
  const meshes::CameraPlace side = still(camera, kNow_s + 30.0);
  EXPECT_NEAR(side.target_m.x - middle.target_m.x, 3.0, 1e-6);
  EXPECT_NEAR(eye_of(side).x - eye_of(middle).x, 3.0, 1e-6);
  EXPECT_EQ(side.heading_deg, middle.heading_deg);
}

TEST(CameraPlace, KeepsItsAngleToTheWind) {
  const look::Camera camera{.heading_deg = 30.0, .wind_angle_deg = 75.0, .distance_m = 9.0};
  const meshes::CameraPlace place = place_of(camera, std::nullopt, kAspect, kNow_s, 240.0);
  EXPECT_EQ(place.heading_deg, 315.0);
  EXPECT_EQ(place.distance_m, 9.0);
  EXPECT_EQ(still(camera).heading_deg, 30.0) << "a daemon that does not send it";
}

TEST(CameraPlace, TurnsWithTheWindAtOneDistanceAndThroughNothing) {
  const meshes::Bounds tree{{-2.0F, 0.0F, -2.0F}, {2.0F, 6.0F, 2.0F}};
  const meshes::Bounds wall{{6.0F, 0.0F, -1.0F}, {7.0F, 3.0F, 1.0F}};
  const std::array obstacles{tree, wall};
  const auto is_in = [](const meshes::Bounds& box, const glm::dvec3& eye_m) {
    return glm::all(glm::greaterThan(eye_m, glm::dvec3(box.low_m))) &&
           glm::all(glm::lessThan(eye_m, glm::dvec3(box.high_m)));
  };
  for (const std::optional<double> distance_m : {std::optional(1.0), std::optional(6.5), std::optional<double>()}) {
    const look::Camera camera{.target_y_m = -2.0, .wind_angle_deg = -75.0, .distance_m = distance_m};
    const double first_m = place_of(camera, tree, kAspect, kNow_s, 0.0, obstacles).distance_m;
    for (double wind_deg = 0.0; wind_deg < 360.0; wind_deg += 1.0) {
      const meshes::CameraPlace place = place_of(camera, tree, kAspect, kNow_s, wind_deg, obstacles);
      EXPECT_EQ(place.distance_m, first_m);
      for (const meshes::Bounds& box : obstacles) EXPECT_FALSE(is_in(box, eye_of(place))) << wind_deg;
    }
  }
  EXPECT_EQ(place_of({.wind_angle_deg = 75.0, .distance_m = 4.0}, tree, kAspect, kNow_s, 0.0, obstacles).distance_m,
            4.0)
      << "between tree and wall there is room";
}

TEST(CameraPlace, NeverJumps) {
  const look::Camera camera{.distance_m = 20.0,
                            .turn_deg_min = 30.0,
                            .sway_deg = 20.0,
                            .pan_deg = 20.0,
                            .dolly_m = 10.0,
                            .track_m = 10.0,
                            .period_s = 30.0};
  // Over more than a whole turn and many periods: an eye's way in a hundredth of a second.
  glm::dvec3 last = eye_of(still(camera));
  double farthest_m = 0.0;
  for (int i = 1; i < 100'000; ++i) {
    const glm::dvec3 next = eye_of(still(camera, kNow_s + 0.01 * i));
    farthest_m = std::max(farthest_m, glm::length(next - last));
    last = next;
  }
  EXPECT_LT(farthest_m, 0.15);
}

}  // namespace
}  // namespace yuragi::viewer::picture
