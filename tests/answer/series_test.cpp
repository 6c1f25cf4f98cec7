#include "tests/answer/series.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "engine/math/philox.hpp"

namespace yuragi::answer {
namespace {

Series rough_series(std::size_t count, std::uint64_t seed) {
  const math::RandomStream random(seed, math::stream_id("answer test"));
  Series series;
  double value = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    value += 0.2 * (random.uniform(i) - 0.5 - value);
    series.push_back(static_cast<float>(value));
  }
  return series;
}

TEST(Series, MeanAndDeviationOfASine) {
  Series sine;
  for (int i = 0; i < 600; ++i)
    sine.push_back(static_cast<float>(3.0 + 2.0 * std::sin(2.0 * std::numbers::pi * i / 60)));
  EXPECT_NEAR(mean(sine), 3.0, 1e-6);
  EXPECT_NEAR(deviation(sine), 2.0 / std::sqrt(2.0), 1e-6);
}

TEST(Series, MedianIsTheMiddleOne) {
  EXPECT_EQ(median({9.0, 1.0, 2.0}), 2.0);
  EXPECT_EQ(median({9.0, 1.0, 2.0, 4.0}), 3.0);
  EXPECT_EQ(median({}), 0.0);
}

TEST(Series, ARunningMeanLeavesTheEndsOut) {
  const Series means = running_mean(Series{1, 2, 3, 4, 5}, 3);
  ASSERT_EQ(means.size(), 3U);
  EXPECT_FLOAT_EQ(means[0], 2.0F);
  EXPECT_FLOAT_EQ(means[2], 4.0F);
}

TEST(Series, LagIsWhatTheSecondIsLater) {
  const Series all = rough_series(6000, 1);
  const Series now(all.begin() + 20, all.end());
  const Series later(all.begin(), all.end() - 20);
  const Lag lag = lag_of(now, later, 60.0, -1.0, 1.0);
  EXPECT_NEAR(lag.seconds, 20.0 / 60.0, 1e-3);
  EXPECT_NEAR(lag.correlation, 1.0, 1e-3);
  EXPECT_NEAR(lag_of(later, now, 60.0, -1.0, 1.0).seconds, -20.0 / 60.0, 1e-3);
}

TEST(Series, LagLiesBetweenSamplesToo) {
  Series first, second;
  for (int i = 0; i < 6000; ++i) {
    const auto at = [i](double delay) { return static_cast<float>(std::sin(0.1 * (i - delay))); };
    first.push_back(at(0.0));
    second.push_back(at(7.4));
  }
  EXPECT_NEAR(lag_of(first, second, 60.0, -0.4, 0.4).seconds, 7.4 / 60.0, 1e-3);
}

TEST(Series, UnrelatedSeriesAreUncorrelated) {
  EXPECT_NEAR(correlation(rough_series(60000, 1), rough_series(60000, 2)), 0.0, 0.05);
  EXPECT_EQ(correlation(Series(10, 1.0F), rough_series(10, 1)), 0.0);
}

}  // namespace
}  // namespace yuragi::answer
