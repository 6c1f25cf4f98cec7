#include "tests/answer/field.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "engine/math/philox.hpp"

namespace yuragi::answer {
namespace {

/// A rough pattern along a line, read at a place in metres.
double pattern(double at_m) {
  const math::RandomStream random(5, math::stream_id("field test"));
  double sum = 0.0;
  for (std::uint64_t wave = 0; wave < 40; ++wave) {
    const double rad_m = 1.0 + 0.1 * static_cast<double>(wave);
    sum += std::sin(rad_m * at_m + 6.28 * random.uniform(wave));
  }
  return sum;
}

std::vector<FieldPoint> carried(double speed_m_s) {
  std::vector<FieldPoint> points;
  for (int across = 0; across < 3; ++across) {
    for (int along = 0; along < 7; ++along) {
      FieldPoint point{.along_m = static_cast<double>(along), .across_m = 2.0 * across, .values = {}};
      for (int i = 0; i < 3600; ++i) {
        point.values.push_back(static_cast<float>(pattern(point.along_m + 31.0 * across - speed_m_s * i / 60.0)));
      }
      points.push_back(std::move(point));
    }
  }
  return points;
}

TEST(FieldSpeed, IsTheSpeedOfWhatIsCarriedOverIt) {
  for (const double speed_m_s : {1.5, 3.0, 8.0}) {
    for (const double distance_m : {1.0, 2.0, 3.0}) {
      EXPECT_NEAR(field_speed_m_s(carried(speed_m_s), {.distance_m = distance_m}, 60.0, 1.0), speed_m_s,
                  0.02 * speed_m_s)
          << distance_m;
    }
  }
}

TEST(FieldSpeed, WhatMovesEverywhereAtOnceHasNone) {
  std::vector<FieldPoint> points = carried(3.0);
  for (FieldPoint& point : points) point.values = points.front().values;
  EXPECT_TRUE(std::isinf(field_speed_m_s(points, {.distance_m = 2.0}, 60.0, 1.0)));
}

TEST(FieldSpeed, WithoutPairsItIsNoNumber) {
  EXPECT_TRUE(std::isnan(field_speed_m_s(carried(3.0), {.distance_m = 40.0}, 60.0, 1.0)));
}

}  // namespace
}  // namespace yuragi::answer
