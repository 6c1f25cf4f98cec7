#include "engine/wind/view_wind.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace yuragi::wind {
namespace {

constexpr double kTick_s = 0.25;

Vector from(double direction_deg, double speed_m_s = 5.0) {
  return wind_from(speed_m_s, direction_deg);
}

void blow(ViewWind& side, double duration_s, Vector wind, bool is_live = true) {
  const auto ticks = std::lrint(std::ceil(duration_s / kTick_s));
  for (long tick = 0; tick < ticks; ++tick) side.advance(kTick_s, wind, is_live);
}

double off_deg(double a_deg, double b_deg) {
  return std::abs(std::remainder(a_deg - b_deg, 360.0));
}

TEST(ViewWind, BeginsWithTheClimateAndTakesTheFirstLiveWindAtOnce) {
  ViewWind side(240.0);
  EXPECT_EQ(side.from_deg(), 240.0);
  blow(side, 1.0, from(100.0));
  EXPECT_NEAR(side.from_deg(), 100.0, 1e-9);
}

TEST(ViewWind, TurnsToASensorThatComesLateInsteadOfJumping) {
  ViewWind side(240.0);
  blow(side, 60.0, from(240.0), false);
  blow(side, 20.0, from(100.0));
  EXPECT_NEAR(side.from_deg(), 230.0, 0.2);
}

TEST(ViewWind, StaysWithinTheDeadBand) {
  ViewWind side(240.0);
  blow(side, 100.0, from(240.0));
  blow(side, 4000.0, from(249.0));
  EXPECT_NEAR(side.from_deg(), 240.0, 1e-9);
  blow(side, 4000.0, from(252.0));
  EXPECT_NEAR(side.from_deg(), 251.0, 1.1) << "beyond the dead band it follows";
}

TEST(ViewWind, FollowsTheMeanOfTenMinutesAndNotAGust) {
  ViewWind side(240.0);
  blow(side, 1000.0, from(240.0));
  blow(side, 20.0, from(330.0));
  EXPECT_NEAR(side.from_deg(), 240.0, 1e-9);
  blow(side, 3000.0, from(330.0));
  EXPECT_NEAR(side.from_deg(), 330.0, ViewWind::kDeadBand_deg);
}

TEST(ViewWind, TurnsByAtMostHalfADegreeASecondTheShortWayThroughNorth) {
  ViewWind side(240.0);
  blow(side, 1.0, from(350.0));
  double last_deg = side.from_deg();
  double fastest_deg = 0.0;
  double farthest_deg = 0.0;
  for (int i = 0; i < 20000; ++i) {
    blow(side, kTick_s, from(20.0));
    fastest_deg = std::max(fastest_deg, off_deg(side.from_deg(), last_deg));
    farthest_deg = std::max(farthest_deg, off_deg(side.from_deg(), 5.0));
    last_deg = side.from_deg();
    ASSERT_GE(last_deg, 0.0);
    ASSERT_LT(last_deg, 360.0);
  }
  EXPECT_LE(fastest_deg, 0.5 * kTick_s + 1e-9);
  EXPECT_LE(farthest_deg, 15.1) << "never through south";
  EXPECT_LE(off_deg(side.from_deg(), 20.0), ViewWind::kDeadBand_deg);
}

TEST(ViewWind, IsHeldInCalmWithoutLiveWindAndForWhatIsNoNumber) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  ViewWind side(240.0);
  blow(side, 100.0, from(100.0));
  const double held_deg = side.from_deg();
  blow(side, 1000.0, from(200.0, 5.0), false);
  EXPECT_EQ(side.from_deg(), held_deg);
  side.advance(kTick_s, {kNan, 3.0}, true);
  side.advance(kTick_s, {3.0, std::numeric_limits<double>::infinity()}, true);
  side.advance(kNan, {3.0, 3.0}, true);
  side.advance(-1.0, {3.0, 3.0}, true);
  EXPECT_EQ(side.from_deg(), held_deg);

  ViewWind calm(240.0);
  blow(calm, 1000.0, from(100.0, 0.9));
  EXPECT_EQ(calm.from_deg(), 240.0);
  EXPECT_EQ(ViewWind(kNan).from_deg(), 0.0);
  EXPECT_EQ(ViewWind(-90.0).from_deg(), 270.0);
}

TEST(ViewWind, GivesTheSameBitsTwice) {
  ViewWind one(240.0);
  ViewWind other(240.0);
  for (int i = 0; i < 5000; ++i) {
    const Vector wind = from(200.0 + 80.0 * std::sin(0.01 * i), 3.0 + 2.0 * std::cos(0.1 * i));
    one.advance(kTick_s, wind, i % 7 != 0);
    other.advance(kTick_s, wind, i % 7 != 0);
    ASSERT_EQ(one.from_deg(), other.from_deg());
  }
}

}  // namespace
}  // namespace yuragi::wind
