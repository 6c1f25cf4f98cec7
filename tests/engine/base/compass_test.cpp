#include "engine/base/compass.hpp"

#include <string>

#include <gtest/gtest.h>

namespace yuragi {
namespace {

TEST(CompassTest, NamesTheNearestPoint) {
  EXPECT_EQ(nearest_compass_point(0.0), "N");
  EXPECT_EQ(nearest_compass_point(359.0), "N");
  EXPECT_EQ(nearest_compass_point(90.0), "E");
  EXPECT_EQ(nearest_compass_point(247.5), "WSW");
  EXPECT_EQ(nearest_compass_point(-22.5), "NNW");
  EXPECT_EQ(nearest_compass_point(720.0 + 100.0), "E");
  EXPECT_EQ(nearest_compass_point(11.24), "N");
  EXPECT_EQ(nearest_compass_point(11.26), "NNE");
}

TEST(CompassTest, APointIsFoundByItsName) {
  for (const std::string_view point : kCompassPoints) {
    const auto direction_deg = compass_point_deg(point);
    ASSERT_TRUE(direction_deg) << point;
    EXPECT_EQ(nearest_compass_point(*direction_deg), point);
  }
  EXPECT_EQ(compass_point_deg("wsw"), 247.5);
  for (const char* name : {"", "north", "NN", "NNNE", "W ", "X"}) EXPECT_FALSE(compass_point_deg(name)) << name;
}

}  // namespace
}  // namespace yuragi
