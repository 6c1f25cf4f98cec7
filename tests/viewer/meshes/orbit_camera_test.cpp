#include "viewer/meshes/orbit_camera.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <gtest/gtest.h>

#include "tests/viewer/test_models.hpp"

namespace yuragi::viewer::meshes {
namespace {

OrbitCamera camera_at(const CameraPlace& place) {
  OrbitCamera camera;
  camera.frame(place);
  return camera;
}

void settle(OrbitCamera& camera) {
  for (int i = 0; i < 200; ++i) camera.advance(0.02);
}

TEST(OrbitCamera, LooksToItsHeadingFromItsDistance) {
  // To the east, level but for a little: the eye is to the west of the target.
  const OrbitCamera camera = camera_at({{1.0, 0.5, 2.0}, 90.0, 30.0, 4.0});
  EXPECT_NEAR(camera.eye_m().x, 1.0 - 4.0 * std::cos(M_PI / 6), 1e-9);
  EXPECT_NEAR(camera.eye_m().y, 0.5 + 2.0, 1e-9);
  EXPECT_NEAR(camera.eye_m().z, 2.0, 1e-9);
}

TEST(OrbitCamera, HasNorthInTheMiddleAndEastToTheRightWhenItLooksNorth) {
  const OrbitCamera camera = camera_at({{0.0, 1.0, 0.0}, 0.0, 5.0, 10.0});
  const glm::mat4 clip = camera.projection(1.5) * camera.view();
  const auto seen = [&](glm::vec3 at) {
    const glm::vec4 p = clip * glm::vec4(at, 1.0F);
    return glm::vec3(p.x, p.y, p.z) / p.w;
  };
  EXPECT_NEAR(seen({0.0F, 1.0F, 0.0F}).x, 0.0F, 1e-5F);
  EXPECT_NEAR(seen({0.0F, 1.0F, 0.0F}).y, 0.0F, 1e-5F);
  EXPECT_GT(seen({1.0F, 1.0F, 0.0F}).x, 0.1F);
  EXPECT_GT(seen({0.0F, 2.0F, 0.0F}).y, 0.1F);
  EXPECT_GT(seen({0.0F, 1.0F, -3.0F}).z, seen({0.0F, 1.0F, 3.0F}).z);
}

TEST(OrbitCamera, TurnsWithTheHandAndStaysAboveTheGround) {
  OrbitCamera camera = camera_at({{0.0, 0.5, 0.0}, 10.0, 20.0, 5.0});
  camera.orbit(0.5, 0.1);
  settle(camera);
  EXPECT_NEAR(camera.place().heading_deg, 10.0 - 90.0, 1e-6);
  EXPECT_NEAR(camera.place().pitch_deg, 38.0, 1e-6);
  camera.orbit(0.0, -100.0);
  settle(camera);
  EXPECT_GT(camera.eye_m().y, 0.0);
  camera.orbit(0.0, 100.0);
  settle(camera);
  EXPECT_LE(camera.place().pitch_deg, OrbitCamera::kMaxPitch_deg);
}

TEST(OrbitCamera, CarriesTheTargetWithThePointer) {
  // Looking north, dragging to the right moves what is seen to the right: the target goes west.
  OrbitCamera camera = camera_at({{0.0, 0.5, 0.0}, 0.0, 20.0, 5.0});
  camera.pan(0.1, 0.0, 16.0 / 9.0);
  settle(camera);
  EXPECT_LT(camera.place().target_m.x, -0.1);
  EXPECT_NEAR(camera.place().target_m.z, 0.0, 1e-9);
  EXPECT_EQ(camera.place().target_m.y, 0.5);
}

TEST(OrbitCamera, ZoomsWithinLimits) {
  OrbitCamera camera = camera_at({{0.0, 0.5, 0.0}, 0.0, 20.0, 5.0});
  camera.zoom(1.0);
  settle(camera);
  EXPECT_LT(camera.place().distance_m, 5.0);
  for (int i = 0; i < 100; ++i) camera.zoom(1e9);
  settle(camera);
  EXPECT_NEAR(camera.place().distance_m, OrbitCamera::kMinDistance_m, 1e-9);
  for (int i = 0; i < 100; ++i) camera.zoom(-1e9);
  settle(camera);
  EXPECT_NEAR(camera.place().distance_m, OrbitCamera::kMaxDistance_m, 1e-6);
}

TEST(OrbitCamera, DoesNotGoOnUnseenWhereItIsKeptAway) {
  OrbitCamera camera = camera_at({{0.0, 1.0, 0.0}, 0.0, 10.0, 3.0});
  for (int i = 0; i < 200; ++i) {
    camera.zoom(1.0);
    camera.advance(0.02);
    camera.keep_away(1.0);
  }
  EXPECT_NEAR(camera.place().distance_m, 1.0, 1e-9);
  camera.zoom(-1.0);
  settle(camera);
  EXPECT_GT(camera.place().distance_m, 1.05);  // at the first notch
}

TEST(OrbitCamera, GlidesWithoutAJump) {
  OrbitCamera camera = camera_at({{0.0, 0.5, 0.0}, 0.0, 20.0, 5.0});
  camera.orbit(1.0, 0.0);
  EXPECT_EQ(camera.place().heading_deg, 0.0);
  double last_deg = 0.0;
  for (int i = 0; i < 100; ++i) {
    camera.advance(0.004);
    EXPECT_LE(std::abs(camera.place().heading_deg - last_deg), 180.0 * 0.05);
    EXPECT_LE(camera.place().heading_deg, last_deg);
    last_deg = camera.place().heading_deg;
  }
}

TEST(OrbitCamera, ComesBackWhenReset) {
  const CameraPlace home{{0.0, 0.5, 0.0}, 45.0, 20.0, 5.0};
  OrbitCamera camera = camera_at(home);
  camera.orbit(0.3, 0.2);
  camera.pan(0.5, 0.5, 1.0);
  camera.zoom(-5.0);
  settle(camera);
  camera.reset();
  settle(camera);
  EXPECT_NEAR(camera.place().heading_deg, home.heading_deg, 1e-6);
  EXPECT_NEAR(camera.place().distance_m, home.distance_m, 1e-6);
  EXPECT_NEAR(camera.place().target_m.x, 0.0, 1e-6);
}

TEST(OrbitCamera, GoesToAnotherHomeOnlyFromTheFirst) {
  OrbitCamera camera = camera_at({{0.0, 0.5, 0.0}, 45.0, 20.0, 5.0});
  camera.move_home({{0.0, 0.5, 0.0}, 45.0, 20.0, 8.0});
  EXPECT_EQ(camera.place().distance_m, 8.0);
  camera.zoom(1.0);
  settle(camera);
  const double by_hand_m = camera.place().distance_m;
  camera.move_home({{0.0, 0.5, 0.0}, 45.0, 20.0, 12.0});
  settle(camera);
  EXPECT_EQ(camera.place().distance_m, by_hand_m);
  camera.reset();
  settle(camera);
  EXPECT_NEAR(camera.place().distance_m, 12.0, 1e-6);
}

TEST(HeadingAcross, LooksAcrossEveryWindFromNoMoreThan60DegreesBesideTheBroadSide) {
  for (double wind_deg = 0.0; wind_deg < 360.0; wind_deg += 1.0) {
    for (const auto& [preferred_deg, broadside_deg] : {std::pair(212.0, 180.0), {238.0, 270.0}, {225.0, 225.0}}) {
      const double heading_deg = heading_across(preferred_deg, broadside_deg, wind_deg);
      EXPECT_GE(std::abs(std::sin((heading_deg - wind_deg) * M_PI / 180.0)), 0.85) << wind_deg;
      EXPECT_LE(std::abs(std::remainder(heading_deg - broadside_deg, 360.0)), 60.1) << wind_deg;
      EXPECT_GE(heading_deg, 0.0);
      EXPECT_LT(heading_deg, 360.0);
    }
  }
  EXPECT_EQ(heading_across(212.0, 180.0, 300.0), 212.0) << "across the wind already";
}

TEST(FirstPlaces, OfEveryKindLookAcrossTheUsualWind) {
  const auto across = [](const CameraPlace& place, double wind_deg) {
    return std::abs(std::sin((place.heading_deg - wind_deg) * M_PI / 180.0));
  };
  const Shore shore(std::get<pose::SurfaceSkeleton>(test_model("ripple").skeleton));
  for (const double wind_deg : {240.0, 0.0, 90.0, 200.0, 315.0}) {
    for (const glm::vec3 size_m : {glm::vec3(2.4F, 2.3F, 0.1F), glm::vec3(0.1F, 4.0F, 2.0F),
                                   glm::vec3(9.0F, 12.0F, 9.0F), glm::vec3(14.0F, 0.6F, 14.0F)}) {
      const Bounds bounds{-0.5F * size_m, 0.5F * size_m};
      EXPECT_GE(across(place_around(bounds, 16.0 / 9.0, wind_deg), wind_deg), 0.85);
      EXPECT_GE(across(place_across(bounds, wind_deg), wind_deg), 0.85);
      EXPECT_GE(across(place_beside(bounds, wind_deg), wind_deg), 0.85);
    }
    EXPECT_GE(across(place_on_shore(shore, wind_deg), wind_deg), 0.85);
  }
  EXPECT_GE(across(place_around({{-1.0F, 0.0F, -1.0F}, {1.0F, 3.0F, 1.0F}}, 1.0), 240.0), 0.85);
}

TEST(OrbitCamera, TurnsByItselfWhenAsked) {
  OrbitCamera camera = camera_at({{0.0, 0.5, 0.0}, 0.0, 20.0, 5.0});
  camera.set_turning(true);
  settle(camera);
  EXPECT_GT(camera.place().heading_deg, 1.0);
}

TEST(OrbitCamera, StaysFiniteWhateverIsAskedOfIt) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  OrbitCamera camera = camera_at({{nan, nan, 1e300}, nan, nan, nan});
  camera.orbit(nan, nan);
  camera.pan(nan, 1e300, 1.0);
  settle(camera);
  EXPECT_TRUE(std::isfinite(camera.eye_m().x + camera.eye_m().y + camera.eye_m().z));
}

TEST(FieldOfView, KeepsTheAreaThatIsSeen) {
  const double usual = tangent_up(40.0, 16.0 / 9.0);
  EXPECT_NEAR(usual, std::tan(20.0 * M_PI / 180.0), 1e-12);
  for (const double aspect : {0.3, 9.0 / 16.0, 1.0, 4.0 / 3.0, 6.0}) {
    const double up = tangent_up(40.0, aspect);
    EXPECT_NEAR(up * up * aspect, usual * usual * 16.0 / 9.0, 1e-12) << aspect;
  }
  EXPECT_LT(2.0 * std::atan(6.0 * tangent_up(40.0, 6.0)) * 180.0 / M_PI, 105.0) << "not drawn out at its ends";
}

TEST(OrbitCamera, LooksUpFromAboveTheGround) {
  const OrbitCamera camera = camera_at({{0.0, 5.0, 0.0}, 0.0, -20.0, 10.0});
  EXPECT_EQ(camera.place().pitch_deg, -20.0);
  EXPECT_NEAR(camera.eye_m().y, 5.0 - 10.0 * std::sin(20.0 * M_PI / 180.0), 1e-9);
  const OrbitCamera low = camera_at({{0.0, 1.0, 0.0}, 0.0, -40.0, 10.0});
  EXPECT_NEAR(low.eye_m().y, OrbitCamera::kMinEye_m, 1e-9);
}

TEST(PlaceAcross, HasTheWholeOfThingsOfAnySizeInFrontOfItFromALowPlace) {
  for (const float size_m : {0.01F, 0.2F, 1.0F, 1.5F, 3.0F, 10.0F, 60.0F}) {
    const Bounds bounds{{-size_m, 0.0F, -size_m}, {size_m, 0.8F, size_m}};
    const OrbitCamera camera = camera_at(place_across(bounds));
    EXPECT_GT(camera.eye_m().y, 0.0);
    EXPECT_LT(camera.place().pitch_deg, 20.0);

    // The middle of the box is in the picture.
    const glm::vec4 middle = camera.projection(16.0 / 9) * camera.view() * glm::vec4(0.0F, 0.4F, 0.0F, 1.0F);
    EXPECT_LT(std::abs(middle.x), middle.w);
    EXPECT_LT(std::abs(middle.y), middle.w);
    EXPECT_LT(middle.z, middle.w);
  }
}

TEST(PlaceOnShore, StandsAtTheWaterAndLooksOverItToTheHorizon) {
  const Shore shore(std::get<pose::SurfaceSkeleton>(test_model("ripple").skeleton));
  OrbitCamera camera;
  camera.frame(place_on_shore(shore));
  const glm::dvec3 eye_m = camera.eye_m();
  EXPECT_NEAR(static_cast<double>(shore.out_m({eye_m.x, eye_m.z})), 0.1, 0.1);
  EXPECT_GT(eye_m.y, 0.3);
  EXPECT_LT(eye_m.y, 1.5);
  // Ahead is the middle of the water, and the horizon is in the picture.
  const glm::dvec2 ahead =
      glm::normalize(glm::dvec2(camera.place().target_m.x, camera.place().target_m.z) - glm::dvec2(eye_m.x, eye_m.z));
  const glm::dvec2 to_middle = glm::normalize(glm::dvec2(shore.middle_m()) - glm::dvec2(eye_m.x, eye_m.z));
  EXPECT_GT(glm::dot(ahead, to_middle), 0.97);
  EXPECT_LT(camera.place().pitch_deg, 0.5 * camera.place().field_of_view_deg);
}

TEST(PlaceBeside, LooksUpToTheRidgeFromOutside) {
  const Bounds back{{-1.5F, 0.0F, -1.0F}, {1.5F, 0.8F, 1.0F}};
  OrbitCamera camera;
  camera.frame(place_beside(back));
  const glm::dvec3 eye_m = camera.eye_m();
  EXPECT_LT(eye_m.y, 0.8);
  EXPECT_GT(std::abs(eye_m.z), 0.9);
  EXPECT_LT(std::abs(eye_m.x), 0.8);
}

TEST(PlaceAround, HasEveryCornerInThePictureAndLooksAtTheBroadSide) {
  const auto looks_along = [](const OrbitCamera& camera) {
    const double heading = camera.place().heading_deg * M_PI / 180.0;
    return glm::dvec3(std::sin(heading), 0.0, -std::cos(heading));
  };
  const auto looks_across = [](const OrbitCamera& camera, double along_deg) {
    return std::abs(std::sin((camera.place().heading_deg - along_deg) * M_PI / 180.0));
  };
  for (const glm::vec3 size_m : {glm::vec3(2.4F, 2.3F, 0.1F), glm::vec3(0.1F, 4.0F, 2.0F), glm::vec3(5.0F, 0.1F, 5.0F),
                                 glm::vec3(9.0F, 12.0F, 9.0F), glm::vec3(12.0F, 5.0F, 8.0F)}) {
    const bool is_flat = size_m.y < 0.5F;
    const glm::vec3 low(3.0F, 0.0F, -7.0F);
    const Bounds bounds{low, low + size_m};
    for (const double aspect : {6.0, 5760.0 / 1080.0, 32.0 / 9.0, 16.0 / 9.0, 1.0, 9.0 / 16.0, 9.0 / 32.0}) {
      const OrbitCamera camera = camera_at(place_around(bounds, aspect));
      EXPECT_GT(camera.eye_m().y, 0.0);
      EXPECT_GT(looks_across(camera, size_m.x >= size_m.z ? 90.0 : 0.0), 0.7);
      const glm::mat4 clip = camera.projection(aspect) * camera.view();
      double widest = 0.0;
      for (int corner = 0; corner < 8; ++corner) {
        const glm::vec3 share(corner & 1, (corner >> 1) & 1, corner >> 2);
        const glm::vec4 seen = clip * glm::vec4(low + share * size_m, 1.0F);
        ASSERT_GT(seen.w, 0.0F);
        const float reach = std::max(std::abs(seen.x), std::abs(seen.y)) / seen.w;
        if (!is_flat) {
          EXPECT_LT(reach, 1.0F);
        }
        widest = std::max(widest, static_cast<double>(reach));
      }
      EXPECT_GT(widest, is_flat ? 1.0 : 0.75);  // and not lost in it; what is flat fills it
      // The horizon is in the picture.
      const glm::vec4 horizon = clip * glm::vec4(camera.eye_m() + 1e5 * glm::dvec3(looks_along(camera)), 1.0);
      EXPECT_LT(std::abs(horizon.y), 0.9F * horizon.w) << aspect;
    }
  }
}

}  // namespace
}  // namespace yuragi::viewer::meshes
