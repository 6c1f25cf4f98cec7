#include "tests/answer/wave_field.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace yuragi::answer {
namespace {

constexpr std::size_t kPoints = 64;
constexpr double kEdge_m = 8.0;

/// A wave of 0.8 m that goes this way at 1.3 m/s, and how WaveField sees it.
WaveField::Strongest seen(Horizontal way, Horizontal downwind) {
  WaveField field(kPoints, kEdge_m, 60.0);
  std::vector<double> heights_m(kPoints * kPoints);
  for (int moment = 0; moment < 20; ++moment) {
    for (const bool is_second : {false, true}) {
      const double t_s = 0.37 * moment + (is_second ? 1.0 / 60.0 : 0.0);
      for (std::size_t row = 0; row < kPoints; ++row) {
        for (std::size_t column = 0; column < kPoints; ++column) {
          const Horizontal place{kEdge_m / kPoints * static_cast<double>(column),
                                 kEdge_m / kPoints * static_cast<double>(row)};
          heights_m[row * kPoints + column] =
              0.02 * std::sin(2.0 * std::numbers::pi / 0.8 * (place.dot(way) - 1.3 * t_s));
        }
      }
      field.take(heights_m, is_second);
    }
  }
  return field.strongest(downwind);
}

TEST(WaveField, AWaveHasItsLengthAndItsSpeedWhereverItGoes) {
  for (const double heading_rad : {0.0, 0.6, 2.0, 3.5, 5.2}) {
    const Horizontal way{std::sin(heading_rad), std::cos(heading_rad)};
    const WaveField::Strongest waves = seen(way, way);
    EXPECT_NEAR(waves.length_m, 0.8, 0.02) << heading_rad;
    EXPECT_NEAR(waves.speed_m_s, 1.3, 0.03) << heading_rad;
  }
}

TEST(WaveField, WhatGoesAgainstTheWindHasANegativeSpeed) {
  EXPECT_NEAR(seen({1.0, 0.0}, {-1.0, 0.0}).speed_m_s, -1.3, 0.03);
}

}  // namespace
}  // namespace yuragi::answer
