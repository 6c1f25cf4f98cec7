#include "engine/wind/blend/direction_keeper.hpp"

#include <cmath>
#include <numbers>
#include <optional>

#include <gtest/gtest.h>

#include "tests/engine/wind/blend/blend_run.hpp"

namespace yuragi::wind::blend {
namespace {

const Vector kFromWest = wind_from(1.0, 270.0);

/// A vane, and what its keeper makes of it: where the wind comes from.
class Vane {
 public:
  explicit Vane(double step_deg = 0.0) : keeper(step_deg) {}
  double direction_after(std::optional<double> direction_deg, double speed_m_s = 5.0, bool otherwise_is_live = false) {
    Reading reading;
    reading.speed_m_s = speed_m_s;
    reading.direction_deg = direction_deg;
    return direction_from_deg(keeper.take(reading, 1.0, kFromWest, otherwise_is_live));
  }
  DirectionKeeper keeper;
};

/// Rounds to the steps of a coarse vane.
double coarse(double direction_deg, double step_deg) {
  return std::fmod(std::round(direction_deg / step_deg) * step_deg + 360.0, 360.0);
}

TEST(DirectionKeeper, BelievesAFineVaneAtOnce) {
  Vane vane;
  for (const double deg : {10.0, 355.0, 183.0, 90.0}) EXPECT_NEAR(vane.direction_after(deg), deg, 1e-9);
  EXPECT_TRUE(vane.keeper.has_vane());
  EXPECT_EQ(vane.keeper.memory_s(), 0.0);
}

TEST(DirectionKeeper, HoldsTheLastDirectionOrTheOneThatIsOffered) {
  Vane vane;
  EXPECT_NEAR(vane.direction_after(std::nullopt), 270.0, 1e-9) << "it never said any";
  EXPECT_NEAR(vane.direction_after(30.0), 30.0, 1e-9);
  EXPECT_NEAR(vane.direction_after(std::nullopt), 30.0, 1e-9);
  EXPECT_FALSE(vane.keeper.has_vane());
  EXPECT_NEAR(vane.direction_after(std::nullopt, 5.0, true), 270.0, 1e-9) << "another measures it now";
}

TEST(DirectionKeeper, InACalmItHoldsTheDirectionTheMoreTheCalmerItIs) {
  Vane vane;
  vane.direction_after(100.0);
  EXPECT_NEAR(vane.direction_after(200.0, 0.0), 100.0, 1e-9);
  const double in_very_little = vane.direction_after(200.0, 0.1);
  EXPECT_GT(in_very_little, 100.0);
  EXPECT_LT(in_very_little, 110.0);
  EXPECT_GT(vane.direction_after(200.0, 0.4), 130.0);
  EXPECT_NEAR(vane.direction_after(200.0, 0.5), 200.0, 1e-9);
}

TEST(DirectionKeeper, TurnsTheShorterWayAndFromTheOppositeToo) {
  const Vector north = wind_from(1.0, 350.0);
  EXPECT_NEAR(std::remainder(direction_from_deg(turned_toward(north, wind_from(1.0, 10.0), 0.5)), 360.0), 0.0, 1e-9);
  const Vector opposite = turned_toward(wind_from(1.0, 0.0), wind_from(1.0, 180.0), 0.25);
  EXPECT_NEAR(std::abs(std::remainder(direction_from_deg(opposite), 360.0)), 45.0, 1e-6);
  EXPECT_NEAR(speed_of(opposite), 1.0, 1e-12);
}

TEST(DirectionKeeper, FindsOutHowCoarseAVaneIs) {
  TestGusts gusts(3);
  for (const double step_deg : {45.0, 22.5}) {
    Vane vane;
    for (int i = 0; i < 100; ++i) vane.direction_after(coarse(200.0 + 20.0 * gusts.normal(), step_deg));
    EXPECT_EQ(vane.keeper.step_deg(), step_deg);
    EXPECT_TRUE(vane.keeper.is_coarse());
  }
  Vane fine;
  for (int i = 0; i < 2000; ++i) {
    fine.direction_after(coarse(200.0 + 20.0 * gusts.normal(), 1.0));
    ASSERT_FALSE(i > 10 && fine.keeper.is_coarse()) << "whole degrees, at reading " << i;
  }
  EXPECT_EQ(Vane(45.0).keeper.step_deg(), 45.0) << "given";
}

TEST(DirectionKeeper, ACoarseVaneNeverLeapsAndItsMeanIsRight) {
  Vane vane(45.0);
  vane.keeper.expect(0.16, 8.0, 1.0);
  EXPECT_GT(vane.keeper.memory_s(), 1.0);
  EXPECT_LT(vane.keeper.memory_s(), 30.0);
  TestGusts gusts(5);
  double before_deg = vane.direction_after(coarse(200.0, 45.0));
  double largest_turn_deg = 0.0;
  double sum_deg = 0.0;
  constexpr int kReadings = 4000;
  for (int i = 0; i < kReadings; ++i) {
    // True: from 200 degrees, give or take 12.
    const double deg = vane.direction_after(coarse(200.0 + 12.0 * gusts.next(), 45.0));
    largest_turn_deg = std::max(largest_turn_deg, std::abs(std::remainder(deg - before_deg, 360.0)));
    before_deg = deg;
    sum_deg += deg;
  }
  EXPECT_LT(largest_turn_deg, 15.0) << "a third of its step";
  EXPECT_NEAR(sum_deg / kReadings, 200.0, 4.0);
}

TEST(DirectionKeeper, TheCalmerTheAirTheLongerACoarseVaneIsSmoothed) {
  DirectionKeeper keeper(45.0);
  keeper.expect(0.2, 8.0, 1.0);
  const double in_gusts_s = keeper.memory_s();
  keeper.expect(0.05, 8.0, 1.0);
  EXPECT_GT(keeper.memory_s(), 2.0 * in_gusts_s);
  keeper.expect(0.0, 8.0, 1.0);
  EXPECT_NEAR(keeper.memory_s(), 100.0, 1e-9);
  EXPECT_TRUE(std::isfinite(keeper.memory_s()));
}

}  // namespace
}  // namespace yuragi::wind::blend
