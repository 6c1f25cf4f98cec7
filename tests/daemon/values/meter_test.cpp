#include "daemon/values/meter.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace yuragi::daemon::values {
namespace {

constexpr double kTick_s = 1.0 / 60.0;
constexpr NormScale kScale{.median_m_s = 4.0, .strong_m_s = 10.0};

/// Adds a wind from the west for so long.
void blow(Meter& meter, double speed_m_s, double duration_s, double tick_s = kTick_s) {
  for (int i = 0; i < std::lround(duration_s / tick_s); ++i) meter.add({speed_m_s, 0.0}, 1.0, 0.1, tick_s, kScale);
}

TEST(MeterTest, ASteadyWindHasNoGust) {
  Meter meter;
  blow(meter, 5.0, 700.0);
  const Readout& readout = meter.readout();
  EXPECT_NEAR(readout[Quantity::kSpeed], 5.0, 1e-9);
  EXPECT_NEAR(readout[Quantity::kDirection], 270.0, 1e-9);
  EXPECT_NEAR(readout[Quantity::kU], 5.0, 1e-9);
  EXPECT_NEAR(readout[Quantity::kV], 0.0, 1e-9);
  EXPECT_NEAR(readout[Quantity::kMean], 5.0, 1e-9);
  EXPECT_NEAR(readout[Quantity::kGust], 0.0, 1e-9);
  EXPECT_NEAR(readout[Quantity::kPeak], 5.0, 1e-9);
  EXPECT_NEAR(readout[Quantity::kGustNorm], 0.0, 1e-6);
  EXPECT_EQ(readout[Quantity::kLive], 1.0);
  EXPECT_EQ(readout[Quantity::kAge], 0.1);
}

TEST(MeterTest, NormIsHalfAtTheMedianAndOneInTheStrongWind) {
  const auto norm_at = [](double speed_m_s) {
    Meter meter;
    blow(meter, speed_m_s, 1.0);
    return meter.readout()[Quantity::kNorm];
  };
  EXPECT_NEAR(norm_at(0.0), 0.0, 1e-9);
  EXPECT_NEAR(norm_at(2.0), 0.25, 1e-9);
  EXPECT_NEAR(norm_at(4.0), 0.5, 1e-9);
  EXPECT_NEAR(norm_at(7.0), 0.75, 1e-9);
  EXPECT_NEAR(norm_at(30.0), 1.0, 1e-9);
}

TEST(MeterTest, TheMeanIsOf100SecondsAtAnyTickRate) {
  for (const double tick_s : {1.0 / 240.0, kTick_s, 0.3, 1.0}) {
    Meter meter;
    blow(meter, 2.0, 1000.0, tick_s);
    blow(meter, 6.0, 50.0, tick_s);
    EXPECT_NEAR(meter.readout()[Quantity::kMean], 4.0, 0.06) << tick_s;
    blow(meter, 6.0, 55.0, tick_s);
    EXPECT_NEAR(meter.readout()[Quantity::kMean], 6.0, 1e-6) << tick_s;
  }
}

TEST(MeterTest, ThePeakIsTheStrongest3SecondsOf10Minutes) {
  Meter meter;
  blow(meter, 3.0, 60.0);
  blow(meter, 9.0, 1.5);  // with 1.5 s of 3 m/s before or behind it: 6 m/s
  blow(meter, 3.0, 10.0);
  EXPECT_NEAR(meter.readout()[Quantity::kPeak], 6.0, 0.3);
  blow(meter, 9.0, 4.0);
  EXPECT_NEAR(meter.readout()[Quantity::kPeak], 9.0, 1e-6);
  blow(meter, 3.0, 590.0);
  EXPECT_NEAR(meter.readout()[Quantity::kPeak], 9.0, 1e-6);
  blow(meter, 3.0, 15.0);
  EXPECT_NEAR(meter.readout()[Quantity::kPeak], 3.0, 1e-6);
}

TEST(MeterTest, AGustOfTwiceTheDeviationIsOne) {
  Meter meter;
  // A sine of 1 m/s has a deviation of 0.707 m/s.
  for (int i = 0; i < 600 * 60; ++i)
    meter.add({5.0 + std::sin(2.0 * M_PI * i * kTick_s / 5.0), 0.0}, 1.0, 0.1, kTick_s, kScale);
  meter.add({5.0 + 0.5 * std::sqrt(2.0), 0.0}, 1.0, 0.1, kTick_s, kScale);
  EXPECT_NEAR(meter.readout()[Quantity::kGustNorm], 0.5, 0.02);
  meter.add({5.0 + 3.0, 0.0}, 1.0, 0.1, kTick_s, kScale);
  EXPECT_EQ(meter.readout()[Quantity::kGustNorm], 1.0);
  meter.add({5.0 - 3.0, 0.0}, 1.0, 0.1, kTick_s, kScale);
  EXPECT_EQ(meter.readout()[Quantity::kGustNorm], 0.0);
}

TEST(MeterTest, TheAgeGrowsWhileNothingIsLive) {
  Meter meter;
  blow(meter, 5.0, 1.0);
  for (int i = 0; i < 120; ++i) meter.add({5.0, 0.0}, 0.0, 0.0, kTick_s, kScale);
  EXPECT_NEAR(meter.readout()[Quantity::kAge], 2.1, 1e-6);
  EXPECT_EQ(meter.readout()[Quantity::kLive], 0.0);
}

TEST(MeterTest, IgnoresWhatIsNotFiniteAndKeepsTheDirectionOfACalm) {
  Meter meter;
  blow(meter, 5.0, 1.0);
  const Readout before = meter.readout();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  meter.add({nan, 1.0}, 1.0, 0.1, kTick_s, kScale);
  EXPECT_EQ(meter.readout(), before);
  meter.add({0.0, 0.0}, 1.0, 0.1, kTick_s, kScale);
  EXPECT_NEAR(meter.readout()[Quantity::kDirection], 270.0, 1e-9);
  meter.add({5.0, 0.0}, 1.0, 0.1, nan, {.median_m_s = 0.0, .strong_m_s = nan});
  for (const QuantityDescription& quantity : quantities())
    EXPECT_TRUE(std::isfinite(meter.readout()[*quantity_named(quantity.name)])) << quantity.name;
}

TEST(MeterTest, HasNoDriftAfterHours) {
  Meter meter;
  for (int second = 0; second < 36'000; ++second) meter.add({0.1 + second % 7, 0.0}, 1.0, 0.1, 1.0, kScale);
  blow(meter, 0.0, 700.0, 1.0);
  EXPECT_NEAR(meter.readout()[Quantity::kMean], 0.0, 1e-9);
  EXPECT_NEAR(meter.readout()[Quantity::kPeak], 0.0, 1e-9);
}

}  // namespace
}  // namespace yuragi::daemon::values
