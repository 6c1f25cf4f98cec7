#include "engine/scenes/rough_water.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "engine/math/critically_damped.hpp"

namespace yuragi::scenes {
namespace {

constexpr double kWaterTick_s = 1.0 / 60.0;

TEST(WaterSlopeVariance, IsCoxAndMunksFromAnOnsetOn) {
  EXPECT_EQ(water_slope_variance(0.0, 1.2), 0.0);
  for (const double wind_m_s : {0.2, 0.6, 0.9, 1.2, 2.0, 4.4, 15.5, 60.0}) {
    const double sea = (0.003 + 0.00512 * wind_m_s) * (1.0 - std::exp(-std::pow(wind_m_s / 1.2, 4.0)));
    EXPECT_NEAR(water_slope_variance(wind_m_s, 1.2), sea, 0.04 * sea) << wind_m_s;
  }
  EXPECT_LT(water_slope_variance(2.0, 4.0), 0.1 * water_slope_variance(2.0, 0.5));
}

TEST(RoughWaterTest, EachNodeFollowsItsWindAndPointsReadBetweenThem) {
  RoughWater water({.columns = 9, .rows = 5, .width_m = 4.0, .depth_m = 2.0, .finest_cell_m = 1.0, .part = 0.5});
  ASSERT_EQ(water.node_columns(), 5U);
  ASSERT_EQ(water.node_rows(), 3U);
  std::vector<float> wind_m_s(15);
  for (std::size_t i = 0; i < 15; ++i) wind_m_s[i] = 2.0F + static_cast<float>(i);
  math::CriticallyDamped reference;
  std::vector<float> slope(45);
  for (int tick = 0; tick < 120; ++tick) {
    water.step(wind_m_s, kWaterTick_s);
    reference.step(std::sqrt(0.5 * water_slope_variance(9.0, 1.2)), RoughWater::kBuildUp_rad_s, kWaterTick_s);
  }
  water.sample(best_simd_row(), slope);
  EXPECT_NEAR(slope[2 * 9 + 4], reference.value, 1e-5);  // node (2, 1), in a wind of 9 m/s
  const double between = (static_cast<double>(slope[2 * 9 + 4]) + static_cast<double>(slope[2 * 9 + 6])) / 2.0;
  EXPECT_NEAR(slope[2 * 9 + 5], between, 1e-6);
  for (int tick = 0; tick < 1200; ++tick) water.step(wind_m_s, kWaterTick_s);
  water.sample(best_simd_row(), slope);
  EXPECT_NEAR(slope.front(), std::sqrt(0.5 * water_slope_variance(2.0, 1.2)), 1e-5);
  EXPECT_NEAR(slope.back(), std::sqrt(0.5 * water_slope_variance(16.0, 1.2)), 1e-5);
}

TEST(RoughWaterTest, IsFlatInCalmAirAndAgainAfterAWindExactly) {
  RoughWater water({.columns = 4, .rows = 4});
  const std::size_t nodes = water.node_columns() * water.node_rows();
  std::vector<float> slope(16, -1.0F);
  const auto is_flat = [&] {
    water.sample(best_simd_row(), slope);
    return std::all_of(slope.begin(), slope.end(), [](float value) { return value == 0.0F; });
  };
  const std::vector<float> calm(nodes, 0.0F);
  water.step(calm, kWaterTick_s);
  EXPECT_TRUE(is_flat());
  water.step(std::vector<float>(nodes, 7.0F), kWaterTick_s);
  EXPECT_FALSE(is_flat());
  for (int tick = 0; tick < 3600; ++tick) water.step(calm, kWaterTick_s);
  EXPECT_TRUE(is_flat());
}

TEST(RoughWaterTest, NoWindMakesItChangeFasterThanItSays) {
  RoughWater water({.columns = 2, .rows = 2});
  const std::size_t nodes = water.node_columns() * water.node_rows();
  std::vector<float> slope(4);
  float before = 0.0F;
  float largest = 0.0F;
  float highest = 0.0F;
  for (int tick = 0; tick < 2400; ++tick) {
    water.step(std::vector<float>(nodes, tick / 80 % 2 == 0 ? 1e6F : 0.0F), kWaterTick_s);
    water.sample(best_simd_row(), slope);
    largest = std::max(largest, std::abs(slope[0] - before));
    highest = std::max(highest, slope[0]);
    before = slope[0];
  }
  EXPECT_LE(static_cast<double>(highest), water.largest_slope() * (1.0 + 1e-5));
  const double bound = water.largest_slope() * RoughWater::kBuildUp_rad_s * kWaterTick_s / std::exp(1.0);
  EXPECT_LE(static_cast<double>(largest), bound * (1.0 + 1e-4));
  EXPECT_GT(static_cast<double>(largest), 0.5 * bound);
}

}  // namespace
}  // namespace yuragi::scenes
