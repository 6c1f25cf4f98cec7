#include "engine/operators/shift_job.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

namespace yuragi::operators {
namespace {

constexpr double kPeriod_m = 256.0;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// A phase as metres, within half a period either way.
double metres(std::uint32_t phase) {
  return static_cast<double>(static_cast<std::int32_t>(phase)) / 4294967296.0 * kPeriod_m;
}

ShiftJob shift(noise::TorusOffset& offset, double east_m_s, double south_m_s, double dt_s) {
  return {
      .wind_east_m_s = east_m_s, .wind_south_m_s = south_m_s, .dt_s = dt_s, .period_m = kPeriod_m, .offset = &offset};
}

TEST(ShiftJobTest, MovesTheFieldToWhereTheWindBlows) {
  noise::TorusOffset offset;
  EXPECT_EQ(shift(offset, 6.0, -2.0, 0.5).run(), ShiftJob::Problem::kNone);
  EXPECT_NEAR(metres(offset.phase().x), 3.0, 1e-6);
  EXPECT_NEAR(metres(offset.phase().z), -1.0, 1e-6);
}

TEST(ShiftJobTest, IntegratesTheWindSoThatANewReadingBendsThePathAndNoMore) {
  noise::TorusOffset offset;
  double x_m = 0.0;
  double z_m = 0.0;
  for (int tick = 0; tick < 600; ++tick) {
    // The wind turns once around, and its speed leaps every 50 ticks.
    const double speed_m_s = (tick / 50) % 2 == 0 ? 3.0 : 11.0;
    const double azimuth_rad = 2.0 * std::numbers::pi * tick / 600.0;
    const double east_m_s = speed_m_s * std::sin(azimuth_rad);
    const double south_m_s = -speed_m_s * std::cos(azimuth_rad);
    const noise::TorusPhase before = offset.phase();
    shift(offset, east_m_s, south_m_s, 1.0 / 60.0).run();
    const noise::TorusPhase moved = offset.phase() - before;
    EXPECT_NEAR(metres(moved.x), east_m_s / 60.0, 1e-6);
    EXPECT_NEAR(metres(moved.z), south_m_s / 60.0, 1e-6);
    x_m += east_m_s / 60.0;
    z_m += south_m_s / 60.0;
  }
  EXPECT_NEAR(metres(offset.phase().x), x_m, 1e-6);
  EXPECT_NEAR(metres(offset.phase().z), z_m, 1e-6);
}

TEST(ShiftJobTest, StepsOfAnyLengthEndAtTheSamePlace) {
  noise::TorusOffset in_one;
  shift(in_one, 7.0, 4.0, 2.0).run();
  noise::TorusOffset in_many;
  for (int i = 0; i < 1000; ++i) shift(in_many, 7.0, 4.0, 0.002).run();
  EXPECT_NEAR(metres(in_many.phase().x - in_one.phase().x), 0.0, 1e-6);
  EXPECT_NEAR(metres(in_many.phase().z - in_one.phase().z), 0.0, 1e-6);
}

TEST(ShiftJobTest, SaysWhatIsWrongAndThenDoesNothing) {
  noise::TorusOffset offset;
  EXPECT_EQ(ShiftJob{}.validate(), ShiftJob::Problem::kNoOffset);
  EXPECT_EQ(shift(offset, kNan, 0.0, 0.1).validate(), ShiftJob::Problem::kWindNotFinite);
  EXPECT_EQ(shift(offset, 0.0, kNan, 0.1).validate(), ShiftJob::Problem::kWindNotFinite);
  EXPECT_EQ(shift(offset, 1.0, 1.0, 0.0).validate(), ShiftJob::Problem::kStepNotPositive);
  EXPECT_EQ(shift(offset, 1.0, 1.0, kNan).validate(), ShiftJob::Problem::kStepNotPositive);
  ShiftJob no_period = shift(offset, 1.0, 1.0, 0.1);
  no_period.period_m = 0.0;
  EXPECT_EQ(no_period.validate(), ShiftJob::Problem::kPeriodNotPositive);
  EXPECT_EQ(no_period.run(), ShiftJob::Problem::kPeriodNotPositive);
  EXPECT_EQ(offset.phase(), noise::TorusPhase{});
  EXPECT_EQ(shift(offset, 1.0, 1.0, 0.1).validate(), ShiftJob::Problem::kNone);
}

}  // namespace
}  // namespace yuragi::operators
