#include "engine/wind/turbulence/turbulence_fit.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "engine/noise/spectral_noise.hpp"
#include "engine/wind/turbulence/von_karman_integrals.hpp"
#include "engine/wind/turbulence/wind_spectrum.hpp"

namespace yuragi::wind::turbulence {
namespace {

constexpr double kNoEnd = std::numeric_limits<double>::infinity();

TEST(VonKarmanShare, AddsUpToOneAndFollowsTheSpectrum) {
  EXPECT_NEAR(von_karman_share(0.0, kNoEnd, 8.0), 1.0, 1e-3);
  double sum = 0.0;
  for (int octave = -16; octave < 14; ++octave) {
    sum += von_karman_share(std::ldexp(1.0, octave), std::ldexp(2.0, octave), 8.0);
  }
  EXPECT_NEAR(
      sum + von_karman_share(0.0, std::ldexp(1.0, -16), 8.0) + von_karman_share(std::ldexp(1.0, 14), kNoEnd, 8.0), 1.0,
      1e-3);
  // Against the spectrum itself: U = 1 m/s, L = 8 m.
  const WindSpectrum spectrum =
      WindSpectrum::make({.model = SpectrumModel::kVonKarman, .speed_m_s = 1.0, .sigma_m_s = 1.0, .length_m = 8.0})
          .value();
  double energy = 0.0;
  for (int k = 0; k < 1000; ++k) energy += spectrum.density_m2_s2_hz(0.1 + 0.2 * (k + 0.5) / 1000) * 0.2 / 1000;
  EXPECT_NEAR(von_karman_share(0.1, 0.3, 8.0), energy, 1e-6);
}

TEST(VonKarmanHaarVariance, GrowsFromSmallDifferencesAndFallsWhereMeansCalmDown) {
  // Neighbouring means over far longer than the time scale T are independent: each has 2 T / tau of the variance.
  EXPECT_NEAR(von_karman_haar_variance(500.0) / (2.0 * 2.0 / 500.0), 1.0, 0.02);
  // Over short ones the structure function's two-thirds law.
  EXPECT_NEAR(von_karman_haar_variance(2e-3) / von_karman_haar_variance(1e-3), std::pow(2.0, 2.0 / 3.0), 0.02);
  EXPECT_GT(von_karman_haar_variance(1.0), von_karman_haar_variance(0.01));
  EXPECT_GT(von_karman_haar_variance(1.0), von_karman_haar_variance(100.0));
}

TEST(VonKarmanMeanVariance, IsTheSpectrumBehindAMovingMean) {
  // Against the integral of the published spectrum, for a time scale of 1 s.
  for (const double tau_s : {0.05, 0.7, 3.0, 40.0, 240.0, 1000.0}) {
    double passed = 0.0;
    for (int k = 0; k < 200'000; ++k) {
      const double f = std::exp(std::log(1e-6) + std::log(1e9) * (k + 0.5) / 200'000);
      const double angle = std::numbers::pi * f * tau_s;
      const double mean = std::sin(angle) / angle;
      passed += 4.0 / std::pow(1.0 + 70.8 * f * f, 5.0 / 6.0) * mean * mean * f * std::log(1e9) / 200'000;
    }
    EXPECT_NEAR(von_karman_mean_variance(tau_s), passed, 0.01) << tau_s;
  }
  EXPECT_NEAR(von_karman_mean_variance(1e-6), 1.0, 0.01);
  EXPECT_NEAR(von_karman_mean_variance(1e6), 2e-6, 1e-7);
}

/// Feeds a line of readings, each scale's differences as an estimator makes them.
void feed(Fit& fit, const std::vector<double>& values, double speed_m_s) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (std::size_t scale = 0; scale < Fit::kScales; ++scale) {
      const std::size_t count = std::size_t{1} << scale;
      if (i + 1 < 2 * count) break;
      double difference = 0.0;
      for (std::size_t k = 0; k < count; ++k) difference += values[i - k] - values[i - count - k];
      fit.add(scale, difference / static_cast<double>(count) / speed_m_s);
    }
  }
}

TEST(TurbulenceFit, APriorWithoutTurbulenceIsFinite) {
  Fit fit({.intensity = 0.0}, 600.0);
  fit.add(0, 0.0);
  fit.fit(1.0, 5.0);
  EXPECT_TRUE(std::isfinite(fit.turbulence().intensity));
  EXPECT_LT(fit.turbulence().intensity, 0.01);
  EXPECT_TRUE(std::isfinite(fit.turbulence().time_scale_s));
  EXPECT_TRUE(std::isfinite(fit.correction(1.0)));
}

TEST(TurbulenceFit, FindsTheIntensityAndTheLengthThatANoiseWasMadeWith) {
  // 64 samples make one reading; 4096 readings of 1 s; L / U = 12 s; TI 0.3 at 7 m/s.
  constexpr std::size_t kSamples = std::size_t{1} << 18U;
  constexpr std::size_t kPerReading = 64;
  constexpr std::size_t kReadings = kSamples / kPerReading;
  constexpr auto kDuration_s = static_cast<double>(kReadings);
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const noise::Tile1 noise =
        noise::make_noise_1d({.size = kSamples, .seed = seed, .integral_scale = 12.0 / kDuration_s}).value();
    std::vector<double> readings;
    for (std::size_t i = 0; i + kPerReading <= kSamples; i += kPerReading) {
      double sum = 0.0;
      for (std::size_t k = 0; k < kPerReading; ++k) sum += static_cast<double>(noise.values[i + k]);
      readings.push_back(7.0 + 0.3 * 7.0 * sum / kPerReading);
    }
    Fit fit({.intensity = 0.1, .length_m = 200.0, .length_weight = 3.0, .intensity_weight = 3.0}, 1e9);
    feed(fit, readings, 7.0);
    fit.fit(1.0, 7.0);
    EXPECT_NEAR(fit.turbulence().intensity, 0.3, 0.03) << seed;
    EXPECT_NEAR(std::log(fit.turbulence().time_scale_s / 12.0), 0.0, 0.3) << seed;
    for (const double f : {0.02, 0.1, 0.5}) EXPECT_NEAR(fit.correction(f), 1.0, 0.25) << seed << ' ' << f;
  }
}

TEST(TurbulenceFit, BelievesItsPriorWhileItHasSeenNothingAndAgainWhenAllIsForgotten) {
  const Prior prior{.intensity = 0.17, .length_m = 57.0, .length_weight = 10.0, .intensity_weight = 10.0};
  Fit fit(prior, 600.0);
  fit.fit(1.0, 5.7);
  EXPECT_NEAR(fit.turbulence().intensity, 0.17, 1e-9);
  EXPECT_NEAR(fit.turbulence().time_scale_s, 10.0, 0.8) << "the nearest step";
  EXPECT_EQ(fit.correction(0.1), 1.0);

  feed(fit, {1.0, 9.0, 2.0, 8.0, 1.0, 9.0, 2.0, 8.0, 1.0, 9.0, 2.0, 8.0, 1.0, 9.0, 2.0, 8.0}, 5.0);
  fit.fit(1.0, 5.7);
  EXPECT_GT(fit.turbulence().intensity, 0.2);
  fit.forget(1e5);
  fit.fit(1.0, 5.7);
  EXPECT_NEAR(fit.turbulence().intensity, 0.17, 1e-3);
}

TEST(TurbulenceFit, StaysFiniteWhateverItIsTold) {
  Fit fit({}, 600.0);
  fit.add(0, std::numeric_limits<double>::quiet_NaN());
  fit.add(0, kNoEnd);
  fit.add(99, 1.0);
  for (int i = 0; i < 100; ++i) fit.add(static_cast<std::size_t>(i % 10), 0.0);
  fit.fit(0.0, 5.0);
  fit.fit(1.0, 0.0);
  fit.fit(1.0, 5.0);
  fit.forget(-5.0);
  EXPECT_TRUE(std::isfinite(fit.turbulence().intensity));
  EXPECT_TRUE(std::isfinite(fit.correction(0.3)));
  EXPECT_EQ(fit.correction(0.0), 1.0);
}

}  // namespace
}  // namespace yuragi::wind::turbulence
