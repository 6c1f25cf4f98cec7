#include "engine/wind/wind_vector.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "engine/wind/wind_reading.hpp"

namespace yuragi::wind {
namespace {

TEST(WindVector, AWindFromTheNorthBlowsSouth) {
  const Vector wind = wind_from(5.0, 0.0);
  EXPECT_NEAR(wind.u_m_s, 0.0, 1e-12);
  EXPECT_NEAR(wind.v_m_s, -5.0, 1e-12);
}

TEST(WindVector, AWindFromTheWestBlowsEast) {
  const Vector wind = wind_from(5.0, 270.0);
  EXPECT_NEAR(wind.u_m_s, 5.0, 1e-12);
  EXPECT_NEAR(wind.v_m_s, 0.0, 1e-12);
}

TEST(WindVector, DirectionAndSpeedComeBack) {
  for (int direction_deg = 0; direction_deg < 360; ++direction_deg) {
    const Vector wind = wind_from(7.0, direction_deg);
    EXPECT_NEAR(speed_of(wind), 7.0, 1e-12);
    EXPECT_NEAR(std::remainder(direction_from_deg(wind) - direction_deg, 360.0), 0.0, 1e-9);
    EXPECT_GE(direction_from_deg(wind), 0.0);
    EXPECT_LT(direction_from_deg(wind), 360.0);
  }
}

TEST(WindVector, TheMiddleOf350And10DegreesIsNorthNotSouth) {
  const Vector middle = 0.5 * (wind_from(4.0, 350.0) + wind_from(4.0, 10.0));
  EXPECT_NEAR(std::remainder(direction_from_deg(middle), 360.0), 0.0, 1e-9);
}

TEST(WindReading, WhatNoWindCanBeIsNotPlausible) {
  const auto reading = [](double speed_m_s) {
    Reading made;
    made.speed_m_s = speed_m_s;
    return made;
  };
  EXPECT_TRUE(is_plausible(reading(0.0)));
  EXPECT_TRUE(is_plausible(reading(113.0)));
  EXPECT_FALSE(is_plausible(reading(-0.1)));
  EXPECT_FALSE(is_plausible(reading(120.5)));
  EXPECT_FALSE(is_plausible(reading(std::numeric_limits<double>::quiet_NaN())));
  EXPECT_FALSE(is_plausible(reading(std::numeric_limits<double>::infinity())));

  Reading odd = reading(3.0);
  odd.direction_deg = 360.0;
  EXPECT_FALSE(is_plausible(odd));
  odd.direction_deg = 359.9;
  EXPECT_TRUE(is_plausible(odd));
  odd.gust_m_s = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(is_plausible(odd));
}

}  // namespace
}  // namespace yuragi::wind
