#include "tests/answer/spectra.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "engine/math/philox.hpp"

namespace yuragi::answer {
namespace {

constexpr double kTestRate_hz = 60.0;

Series sine(double frequency_hz, double amplitude, std::size_t count = 18000) {
  Series series;
  for (std::size_t i = 0; i < count; ++i) {
    const double turn_rad = 2.0 * std::numbers::pi * frequency_hz * static_cast<double>(i) / kTestRate_hz;
    series.push_back(static_cast<float>(amplitude * std::sin(turn_rad)));
  }
  return series;
}

Series sum(Series first, const Series& second) {
  for (std::size_t i = 0; i < first.size(); ++i) first[i] += second[i];
  return first;
}

TEST(Spectrum, ASineHasItsPeakItsCentroidAndItsVariance) {
  const Spectrum spectrum = Welch(kTestRate_hz).of(sine(1.7, 3.0));
  EXPECT_NEAR(spectrum.peak_hz(0.3, 30.0), 1.7, 1e-9);
  EXPECT_NEAR(spectrum.centroid_hz(0.3), 1.7, 1e-3);
  EXPECT_NEAR(spectrum.deviation_above(0.3), 3.0 / std::sqrt(2.0), 0.01);
}

TEST(Spectrum, AllLinesTogetherAreTheVariance) {
  const math::RandomStream random(7, math::stream_id("spectrum test"));
  Series white;
  for (std::size_t i = 0; i < 18000; ++i) white.push_back(static_cast<float>(random.uniform(i)));
  const Spectrum spectrum = Welch(kTestRate_hz).of(white);
  EXPECT_NEAR(spectrum.variance(0.0, kTestRate_hz), 1.0 / 12.0, 0.002);
  // White: as much in each Hz.
  EXPECT_NEAR(spectrum.variance(10.0, 20.0), 1.0 / 36.0, 0.001);
}

TEST(Spectrum, WhatIsSlowerThanTheBandDoesNotCount) {
  const Spectrum spectrum = Welch(kTestRate_hz).of(sum(sine(0.1, 10.0), sine(2.0, 1.0)));
  EXPECT_NEAR(spectrum.peak_hz(0.3, 30.0), 2.0, 1e-9);
  EXPECT_NEAR(spectrum.deviation_above(0.5), 1.0 / std::sqrt(2.0), 0.01);
}

TEST(Spectrum, AMeanIsNoMotion) {
  EXPECT_NEAR(Welch(kTestRate_hz).of(Series(6000, 5.0F)).deviation_above(0.0), 0.0, 1e-9);
}

TEST(Spectrum, OfTwoComponentsTheVariancesAddUp) {
  Welch welch(kTestRate_hz);
  Spectrum both = welch.of(sine(1.0, 1.0));
  both += welch.of(sine(3.0, 1.0));
  EXPECT_NEAR(both.variance(0.0, kTestRate_hz), 1.0, 0.01);
  EXPECT_NEAR(both.centroid_hz(0.3), 2.0, 0.01);
}

TEST(HighPassed, KeepsWhatIsQuickAndDropsWhatIsSlow) {
  const Series high = high_passed(sum(sine(0.1, 10.0), sine(2.0, 1.0)), kTestRate_hz, 0.3);
  const Series expected = sine(2.0, 1.0);
  ASSERT_EQ(high.size(), expected.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < high.size(); ++i) {
    largest = std::max(largest, std::abs(static_cast<double>(high[i] - expected[i])));
  }
  EXPECT_LT(largest, 1e-4);
}

}  // namespace
}  // namespace yuragi::answer
