#include "engine/look/camera.hpp"

#include <array>
#include <limits>
#include <string>

#include <gtest/gtest.h>

namespace yuragi::look {
namespace {

Result<Camera, ParameterError> camera_from(const ParameterValues::Map& given) {
  const auto values = ParameterValues::resolve(camera_parameters(), given);
  if (!values) return values.error();
  return camera_of("evening", *values);
}

TEST(Camera, HasADefaultForEverythingButItsName) {
  const auto camera = camera_from({});
  ASSERT_TRUE(camera);
  EXPECT_EQ(*camera, Camera{.name = "evening"});
}

TEST(Camera, TakesEveryValue) {
  const auto camera = camera_from({{"scene", std::string("fire")},
                                   {"target_x", 1.0},
                                   {"target_y", 2.0},
                                   {"target_z", 3.0},
                                   {"heading", 90.0},
                                   {"wind_angle", -75.0},
                                   {"pitch", -5.0},
                                   {"distance", 12.0},
                                   {"fov", 25.0},
                                   {"turn", 6.0},
                                   {"sway", 7.0},
                                   {"pan", 8.0},
                                   {"dolly", 2.5},
                                   {"track", 1.5},
                                   {"period", 300.0},
                                   {"from", std::string("21:15")},
                                   {"fade", 30.0}});
  ASSERT_TRUE(camera);
  EXPECT_EQ(*camera, (Camera{.name = "evening",
                             .scene = "fire",
                             .target_x_m = 1.0,
                             .target_y_m = 2.0,
                             .target_z_m = 3.0,
                             .heading_deg = 90.0,
                             .wind_angle_deg = -75.0,
                             .pitch_deg = -5.0,
                             .distance_m = 12.0,
                             .fov_deg = 25.0,
                             .turn_deg_min = 6.0,
                             .sway_deg = 7.0,
                             .pan_deg = 8.0,
                             .dolly_m = 2.5,
                             .track_m = 1.5,
                             .period_s = 300.0,
                             .from_h = 21.25,
                             .fade_s = 30.0}));
}

TEST(Camera, RefusesMistakesByName) {
  EXPECT_EQ(camera_from({{"from", std::string("dusk")}}).error().name, "from");
  EXPECT_EQ(camera_from({{"from", std::string("24:00")}}).error().name, "from") << "that is 00:00";
  EXPECT_EQ(camera_from({{"wind_angle", 200.0}}).error().name, "wind_angle");
  EXPECT_EQ(camera_from({{"fov", 180.0}}).error().name, "fov");
  EXPECT_EQ(camera_from({{"period", 0.0}}).error().name, "period");
  EXPECT_EQ(camera_from({{"zoom", 2.0}}).error().name, "zoom");
}

TEST(Camera, IsBroughtWithinLimits) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Camera hostile;
  for (double Camera::*member :
       {&Camera::target_x_m, &Camera::target_y_m, &Camera::target_z_m, &Camera::heading_deg, &Camera::pitch_deg,
        &Camera::fov_deg, &Camera::turn_deg_min, &Camera::sway_deg, &Camera::pan_deg, &Camera::dolly_m,
        &Camera::track_m, &Camera::period_s, &Camera::fade_s}) {
    hostile.*member = kNan;
  }
  hostile.distance_m = kInfinity;
  hostile.wind_angle_deg = kNan;
  hostile.from_h = -1.0;
  EXPECT_EQ(within_limits(hostile), Camera{});
  EXPECT_EQ(within_limits({.wind_angle_deg = -200.0, .distance_m = 1e9, .period_s = -3.0, .from_h = 24.0}),
            (Camera{.wind_angle_deg = -180.0, .distance_m = 200.0, .period_s = 10.0}));
  EXPECT_EQ(within_limits(Camera{.name = "a"}), Camera{.name = "a"});
}

TEST(CameraAt, IsTheLatestOfTheDay) {
  const std::array cameras{Camera{.name = "spare"}, Camera{.name = "day", .from_h = 9.0},
                           Camera{.name = "night", .from_h = 21.5}, Camera{.name = "dawn", .from_h = 5.0}};
  const auto at = [&](double hour) { return cameras.at(camera_at(cameras, hour)).name; };
  EXPECT_EQ(at(5.0), "dawn");
  EXPECT_EQ(at(8.99), "dawn");
  EXPECT_EQ(at(9.0), "day");
  EXPECT_EQ(at(21.49), "day");
  EXPECT_EQ(at(21.5), "night");
  EXPECT_EQ(at(23.99), "night");
  EXPECT_EQ(at(0.0), "night") << "over midnight";
  EXPECT_EQ(at(4.99), "night");
}

TEST(CameraAt, IsTheFirstWhereNoneHasATime) {
  EXPECT_EQ(camera_at(std::array{Camera{.name = "a"}, Camera{.name = "b"}}, 12.0), 0U);
  EXPECT_EQ(camera_at({}, 12.0), 0U);
}

}  // namespace
}  // namespace yuragi::look
