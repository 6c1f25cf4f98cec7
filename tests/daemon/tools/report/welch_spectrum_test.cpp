#include "daemon/tools/report/welch_spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>

#include <gtest/gtest.h>

#include "engine/math/philox.hpp"

namespace yuragi::daemon::tools::report {
namespace {

constexpr double kStep_s = 0.1;

/// A periodic series whose one-sided spectrum is `density(f)`, with phases by chance and amplitudes without any.
template <class Density>
std::vector<double> series_with(std::size_t size, Density&& density) {
  fft::RealFft fft(1, size);
  const math::RandomStream random(42, math::stream_id("welch test"));
  const double length_s = kStep_s * static_cast<double>(size);
  for (std::size_t k = 1; k < size / 2; ++k) {
    const double phase_rad = 2.0 * std::numbers::pi * random.uniform(k);
    const double amplitude = 0.5 * std::sqrt(2.0 * density(static_cast<double>(k) / length_s) / length_s);
    fft.spectrum()[k] = std::polar(amplitude, phase_rad);
  }
  fft.inverse();
  return {fft.samples().begin(), fft.samples().end()};
}

/// As published, and not by engine/wind/turbulence/von_karman.hpp, which is under test here.
double von_karman(double f, double sigma_m_s, double time_scale_s) {
  const double x = f * time_scale_s;
  return 4.0 * sigma_m_s * sigma_m_s * time_scale_s / std::pow(1.0 + 70.8 * x * x, 5.0 / 6.0);
}

SpectrumNumbers spectrum_of(const std::vector<double>& along_m_s, double mean_m_s, std::size_t segment = 4096) {
  WelchSpectrum welch(segment, kStep_s, false);
  for (const double value : along_m_s) {
    // From the south-west: as much east as north.
    const double part = (mean_m_s + value) / std::numbers::sqrt2;
    welch.add({.speed_m_s = std::abs(mean_m_s + value), .wind = wind::Vector{part, part}});
  }
  const auto numbers = welch.numbers();
  EXPECT_TRUE(numbers);
  return numbers.value_or(SpectrumNumbers{});
}

TEST(WelchSpectrum, TheIntegralIsTheVarianceAndASineIsWhereItIs) {
  std::vector<double> sine(40'960);
  for (std::size_t i = 0; i < sine.size(); ++i) {
    sine[i] = 1.5 * std::sin(2.0 * std::numbers::pi * 0.5 * kStep_s * static_cast<double>(i));
  }
  const SpectrumNumbers numbers = spectrum_of(sine, 7.0);
  const auto& density = numbers.density_m2_s2_hz;
  const double variance = std::accumulate(density.begin(), density.end(), 0.0) * numbers.frequency_hz(1);
  EXPECT_NEAR(variance, 1.5 * 1.5 / 2.0, 0.002);
  const auto peak = static_cast<std::size_t>(std::ranges::max_element(density) - density.begin());
  EXPECT_NEAR(numbers.frequency_hz(peak), 0.5, numbers.frequency_hz(1));
  EXPECT_EQ(numbers.segments, 19U);
}

TEST(WelchSpectrum, WhatIsAcrossTheWindIsNotInIt) {
  WelchSpectrum welch(256, kStep_s, false);
  for (int i = 0; i < 1024; ++i) welch.add({.speed_m_s = 6.0, .wind = wind::Vector{6.0, i % 2 == 0 ? 1.0 : -1.0}});
  const auto numbers = welch.numbers();
  ASSERT_TRUE(numbers);
  for (const double density : numbers->density_m2_s2_hz) EXPECT_NEAR(density, 0.0, 1e-12);
}

TEST(WelchSpectrum, ATrendIsTakenOut) {
  WelchSpectrum welch(256, kStep_s, true);
  for (int i = 0; i < 256; ++i) welch.add({.speed_m_s = 5.0 + 0.01 * i, .wind = {}});
  const auto numbers = welch.numbers();
  ASSERT_TRUE(numbers);
  for (const double density : numbers->density_m2_s2_hz) EXPECT_NEAR(density, 0.0, 1e-12);
}

TEST(WelchSpectrum, AnInterruptionBeginsANewSegment) {
  WelchSpectrum welch(64, kStep_s, true);
  for (int i = 0; i < 63; ++i) welch.add({.speed_m_s = 5.0, .wind = {}});
  welch.interrupt();
  for (int i = 0; i < 63; ++i) welch.add({.speed_m_s = 5.0, .wind = {}});
  EXPECT_FALSE(welch.numbers());
  welch.add({.speed_m_s = 5.0, .wind = {}});
  ASSERT_TRUE(welch.numbers());
  EXPECT_EQ(welch.numbers()->segments, 1U);
}

TEST(SpectrumFit, FindsTheSlopeThatIsThere) {
  for (const double beta : {1.0, 5.0 / 3.0, 2.0}) {
    const auto numbers = spectrum_of(series_with(1 << 17, [&](double f) { return 0.1 * std::pow(f, -beta); }), 20.0);
    ASSERT_TRUE(numbers.power_law);
    EXPECT_NEAR(numbers.power_law->beta, beta, 0.03);
    EXPECT_NEAR(std::exp(numbers.power_law->log_level), 0.1, 0.01);
    EXPECT_DOUBLE_EQ(numbers.power_law->to_hz, 2.0);
    EXPECT_DOUBLE_EQ(numbers.power_law->from_hz, 0.2);
  }
}

TEST(SpectrumFit, FindsTheThreeNumbersOfVonKarman) {
  for (const double time_scale_s : {3.0, 10.0}) {
    const auto numbers =
        spectrum_of(series_with(1 << 18, [&](double f) { return von_karman(f, 1.6, time_scale_s); }), 8.0);
    ASSERT_TRUE(numbers.von_karman);
    EXPECT_NEAR(numbers.von_karman->speed_m_s, 8.0, 0.05);
    EXPECT_NEAR(numbers.von_karman->intensity, 0.2, 0.01);
    ASSERT_TRUE(numbers.von_karman->length_m);
    EXPECT_NEAR(*numbers.von_karman->length_m, 8.0 * time_scale_s, 0.08 * 8.0 * time_scale_s);
    EXPECT_LT(numbers.von_karman->rms_db, 0.3);
    for (const OctaveBand& band : numbers.octaves) {
      if (!band.is_in_fit) continue;
      EXPECT_NEAR(band.variance_m2_s2 / *band.fitted_m2_s2, 1.0, 0.12) << band.from_hz;
    }
  }
}

TEST(SpectrumFit, TellsNoLengthWhereTheBendIsNotSeen) {
  // A pure power law has no bend; white noise has none either.
  for (const double beta : {5.0 / 3.0, 0.0}) {
    const auto numbers = spectrum_of(series_with(1 << 16, [&](double f) { return 0.05 * std::pow(f, -beta); }), 20.0);
    ASSERT_TRUE(numbers.von_karman);
    EXPECT_FALSE(numbers.von_karman->length_m) << *numbers.von_karman->length_m;
  }
}

TEST(SpectrumFit, OctavesAreBetweenPowersOfTwo) {
  const auto numbers = spectrum_of(series_with(1 << 16, [](double) { return 0.25; }), 20.0);
  ASSERT_FALSE(numbers.octaves.empty());
  EXPECT_DOUBLE_EQ(numbers.octaves.front().from_hz, 1.0 / 256.0);
  EXPECT_DOUBLE_EQ(numbers.octaves.back().to_hz, 4.0);
  for (const OctaveBand& band : numbers.octaves) {
    EXPECT_DOUBLE_EQ(band.to_hz, 2.0 * band.from_hz);
    if (!band.is_in_fit) continue;
    EXPECT_NEAR(band.variance_m2_s2, 0.25 * band.from_hz, 0.1 * 0.25 * band.from_hz);
  }
}

TEST(IntegralTime, IsThatOfAnExponentialCorrelation) {
  // S = 4 s^2 T / (1 + (2 pi f T)^2) has the autocorrelation exp(-t / T), whose integral is T.
  constexpr double kTime_s = 4.0;
  const auto series = series_with(
      1 << 18, [](double f) { return 4.0 * kTime_s / (1.0 + std::pow(2.0 * std::numbers::pi * f * kTime_s, 2.0)); });
  IntegralTime integral(1 << 14, kStep_s);
  for (const double value : series) integral.add(9.0 + value);
  ASSERT_TRUE(integral.seconds());
  EXPECT_NEAR(*integral.seconds(), kTime_s, 0.4);
}

TEST(IntegralTime, IsNotOfASteadyWindNorOfLessThanABlock) {
  IntegralTime integral(100, kStep_s);
  for (int i = 0; i < 99; ++i) integral.add(5.0 + i);
  EXPECT_FALSE(integral.seconds());
  IntegralTime steady(100, kStep_s);
  for (int i = 0; i < 100; ++i) steady.add(5.0);
  EXPECT_FALSE(steady.seconds());
}

}  // namespace
}  // namespace yuragi::daemon::tools::report
