#include "viewer/meshes/frustum.hpp"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/vec4.hpp>
#include <gtest/gtest.h>

#include "viewer/meshes/view.hpp"

namespace yuragi::viewer::meshes {
namespace {

constexpr double kSmall = 1e-9;

TEST(FrustumThrough, IsEvenForAnEyeBeforeTheMiddle) {
  const Frustum frustum = frustum_through({-1, 0, 0}, {1, 0, 0}, {-1, 1, 0}, {0, 0.5, 2});
  EXPECT_NEAR(frustum.left, -0.5, kSmall);
  EXPECT_NEAR(frustum.right, 0.5, kSmall);
  EXPECT_NEAR(frustum.bottom, -0.25, kSmall);
  EXPECT_NEAR(frustum.top, 0.25, kSmall);
}

/// Kooima's property: what is on the screen is seen where it is on the screen, wherever eye and screen are in the room.
TEST(FrustumThrough, ShowsEachPlaceOfTheScreenWhereItIs) {
  const glm::dvec3 lower_left(1.0, 0.5, -2.0);
  const glm::dvec3 right = glm::normalize(glm::dvec3(2.0, 0.0, 1.0));
  const glm::dvec3 up = glm::normalize(glm::cross(glm::dvec3(-1.0, 0.3, 2.0), right));
  const glm::dvec3 lower_right = lower_left + 3.0 * right;
  const glm::dvec3 upper_left = lower_left + 1.5 * up;
  const glm::dvec3 to_eye = glm::cross(right, up);
  const glm::dvec3 eye = lower_left + 0.4 * right + 2.0 * up + 1.7 * to_eye;
  const glm::dmat4 projection = projection_of(frustum_through(lower_left, lower_right, upper_left, eye), 0.1, 100.0);
  for (const double x : {0.0, 0.3, 1.0}) {
    for (const double y : {0.0, 0.8, 1.0}) {
      const glm::dvec3 from_eye = lower_left + 3.0 * x * right + 1.5 * y * up - eye;
      const glm::dvec4 clip =
          projection * glm::dvec4(glm::dot(right, from_eye), glm::dot(up, from_eye), glm::dot(to_eye, from_eye), 1.0);
      EXPECT_NEAR(clip.x / clip.w, 2.0 * x - 1.0, kSmall);
      EXPECT_NEAR(clip.y / clip.w, 2.0 * y - 1.0, kSmall);
    }
  }
}

/// The rays of the sky have to meet the things in front of it.
TEST(ViewThroughAScreen, HasRaysThatGoWhereThePlacesAreProjected) {
  OrbitCamera camera;
  camera.frame({.target_m = {3.0, 1.0, 2.0}, .heading_deg = 40.0, .pitch_deg = 12.0, .distance_m = 7.0});
  camera.see_through(Frustum{.left = -0.2, .right = 0.9, .bottom = -0.6, .top = 0.1});
  const View view = view_of(camera, 1100, 700);
  for (const float x : {-1.0F, 0.2F, 1.0F}) {
    for (const float y : {-1.0F, 0.5F, 1.0F}) {
      // As sky.vert.glsl makes them.
      const glm::vec3 ray =
          glm::vec3(view.forward) + glm::vec3(view.right) * (x * view.right.w) + glm::vec3(view.up) * (y * view.up.w);
      const glm::vec4 clip = view.to_clip * glm::vec4(glm::vec3(view.eye_m) + 50.0F * ray, 1.0F);
      EXPECT_NEAR(clip.x / clip.w, x, 1e-4F);
      EXPECT_NEAR(clip.y / clip.w, y, 1e-4F);
    }
  }
  EXPECT_NEAR(view.eye_m.w, 0.7F / 700.0F, 1e-7F);
}

TEST(BearingsOf, AreThoseOfAllPixelsAndAllAroundTowardTheZenith) {
  for (const double pitch_deg : {-40.0, 0.0, 25.0, 85.0}) {
    for (const double heading_deg : {0.0, 40.0, 179.0, 350.0}) {
      OrbitCamera camera;
      camera.frame({.target_m = {0.0, 9.0, 0.0}, .heading_deg = heading_deg, .pitch_deg = pitch_deg});
      const View view = view_of(camera, 1600, 900);
      const Arc arc = bearings_of(view);
      const float turn_rad = glm::two_pi<float>();
      EXPECT_EQ(arc.size_rad >= turn_rad, pitch_deg > 80.0) << pitch_deg;
      EXPECT_TRUE(arc.from_rad >= 0.0F && arc.from_rad < turn_rad) << arc.from_rad;
      if (pitch_deg == 0.0) {
        EXPECT_NEAR(arc.size_rad, 2.0F * std::atan(view.right.w), 1e-5F);
      }
      for (const float x : {-1.0F, -0.6F, 0.0F, 0.3F, 1.0F}) {
        for (const float y : {-1.0F, -0.2F, 0.5F, 1.0F}) {
          const glm::vec3 ray = glm::vec3(view.forward) + glm::vec3(view.right) * (view.right.w * x) +
                                glm::vec3(view.up) * (view.up.w * y);
          const float from_rad = std::atan2(ray.x, -ray.z) - arc.from_rad;
          const float inside_rad = from_rad - turn_rad * std::floor((from_rad + 1e-4F) / turn_rad);
          EXPECT_LE(inside_rad, arc.size_rad + 1e-4F) << heading_deg << " " << x << " " << y;
        }
      }
    }
  }
}

TEST(ViewThroughAScreen, IsTheSameAsWithoutOneWhereTheFrustumIsTheCameras) {
  OrbitCamera camera;
  camera.frame({.heading_deg = 200.0, .field_of_view_deg = 50.0});
  const View without = view_of(camera, 1600, 900);
  const double up = tangent_up(50.0, 16.0 / 9.0);
  camera.see_through(Frustum{.left = -up * 16.0 / 9.0, .right = up * 16.0 / 9.0, .bottom = -up, .top = up});
  const View with = view_of(camera, 1600, 900);
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) EXPECT_NEAR(with.to_clip[column][row], without.to_clip[column][row], 1e-5F);
  }
  EXPECT_NEAR(with.right.w, without.right.w, 1e-6F);
  EXPECT_NEAR(with.forward.x, without.forward.x, 1e-6F);
}

}  // namespace
}  // namespace yuragi::viewer::meshes
