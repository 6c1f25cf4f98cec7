#include "engine/wind/blend/relative_scale.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/engine/wind/blend/blend_run.hpp"

namespace yuragi::wind::blend {
namespace {

/// A relative source that says a third of the gusts and adds 2 m/s to a third of the mean of 6 m/s.
void measure_for(RelativeScale& scale, int seconds, double gust_scale = 3.0, double independent_after_s = 10.0) {
  TestGusts gusts(1);
  for (int i = 0; i < seconds; ++i) {
    const double gust_m_s = gusts.next();
    scale.learn({.speed_m_s = 6.0,
                 .relative_speed_m_s = 4.0,
                 .gust_m_s = gust_m_s,
                 .relative_gust_m_s = gust_m_s / gust_scale,
                 .independent_after_s = independent_after_s},
                1.0);
  }
}

TEST(RelativeScale, IsOneAsLongAsNothingIsKnown) {
  const RelativeScale scale(600.0);
  EXPECT_EQ(scale.mean_gain(), 1.0);
  EXPECT_EQ(scale.gust_gain(), 1.0);
}

TEST(RelativeScale, FindsTheGainOfTheGustsAndThatOfTheMean) {
  RelativeScale scale(600.0);
  measure_for(scale, 1800);
  EXPECT_NEAR(scale.mean_gain(), 1.5, 0.05);
  EXPECT_NEAR(scale.gust_gain(), 3.0, 0.3) << "not that of the mean: the source has an offset";
}

TEST(RelativeScale, FollowsTheMeansWhereTheGustsTellNothing) {
  RelativeScale scale(600.0);
  measure_for(scale, 600, 3.0, 1e6);
  EXPECT_NEAR(scale.gust_gain(), 1.5, 0.05);
}

TEST(RelativeScale, ChangesSlowlyAndStaysWithinBounds) {
  RelativeScale scale(600.0);
  double before = 1.0;
  TestGusts gusts(2);
  for (int i = 0; i < 6000; ++i) {
    const double gust_m_s = gusts.next();
    scale.learn({.speed_m_s = 8.0,
                 .relative_speed_m_s = 1e-5,
                 .gust_m_s = gust_m_s,
                 .relative_gust_m_s = 1e-4 * gust_m_s,
                 .independent_after_s = 10.0},
                1.0 / 60.0);
    EXPECT_LT(std::abs(std::log(scale.gust_gain() / before)), 0.02);
    before = scale.gust_gain();
    ASSERT_LE(scale.gust_gain(), 20.0 * (1.0 + 1e-9));
  }
  for (int i = 0; i < 1000; ++i) scale.learn({.independent_after_s = 1.0}, 100.0);
  EXPECT_TRUE(std::isfinite(scale.gust_gain()) && scale.gust_gain() > 0.0);
}

}  // namespace
}  // namespace yuragi::wind::blend
