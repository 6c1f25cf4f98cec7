#include "engine/wind/turbulence/sampled_turbulence.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "engine/wind/turbulence/von_karman.hpp"
#include "engine/wind/turbulence/von_karman_integrals.hpp"

namespace yuragi::wind::turbulence {
namespace {

/// Haar's variance of samples by the spectrum: of each wave the mean of `count` samples is Dirichlet's kernel.
double haar_by_spectrum(int count, double ratio, double (*density)(double)) {
  constexpr int kSteps = 400'000;
  const double log_step = std::log(1e10) / kSteps;
  double sum = 0.0;
  for (int k = 0; k <= kSteps; ++k) {
    const double x = 1e-5 * std::exp(log_step * k);
    const double angle = std::numbers::pi * x * ratio;
    const double own = std::sin(angle);
    const double mean = std::abs(own) < 1e-9 ? 1.0 : std::sin(count * angle) / (count * own);
    const double passed = 2.0 * mean * std::sin(count * angle);
    sum += x * density(x) * passed * passed * log_step;
  }
  return sum;
}

TEST(SampledTurbulence, DifferencesOfSamplesAreThoseOfTheSpectrum) {
  for (const std::size_t scale : {std::size_t{0}, std::size_t{2}, std::size_t{5}}) {
    for (const double ratio : {0.05, 0.4, 3.0}) {
      const double along = haar_by_spectrum(1 << scale, ratio, von_karman_density);
      const double across = haar_by_spectrum(1 << scale, ratio, von_karman_density_across);
      EXPECT_NEAR(von_karman_sampled_haar_variance(scale, ratio) / along, 1.0, 0.01) << scale << ' ' << ratio;
      EXPECT_NEAR(von_karman_sampled_haar_variance(scale, ratio, WindComponent::kAcross) / across, 1.0, 0.01)
          << scale << ' ' << ratio;
    }
  }
}

TEST(SampledTurbulence, DifferencesAreThoseOfMeansWhereSamplesAreClose) {
  EXPECT_NEAR(von_karman_sampled_haar_variance(5, 0.01) / von_karman_haar_variance(0.32), 1.0, 0.01);
  EXPECT_EQ(von_karman_sampled_haar_variance(9, 0.01), von_karman_haar_variance(5.12));
  // Samples that are far apart have nothing in common: a mean of n of them has the n-th part of the variance.
  EXPECT_NEAR(von_karman_sampled_haar_variance(0, 500.0), 2.0, 0.01);
  EXPECT_NEAR(von_karman_sampled_haar_variance(3, 500.0), 0.25, 0.005);
}

TEST(SampledTurbulence, WhatIsTheWindsOwnIsItsPartOfAllThatLooksAlike) {
  for (const double interval_s : {0.5, 14.0, 120.0}) {
    for (const double cycles : {0.0, 0.1, 0.5, 0.8, 2.3}) {
      constexpr double kScale_s = 8.0;
      const double frequency_hz = cycles / interval_s;
      double all = 0.0;
      for (int k = -100'000; k <= 100'000; ++k)
        all += von_karman_density(std::abs(frequency_hz + k / interval_s) * kScale_s);
      EXPECT_NEAR(von_karman_unfolded_part(frequency_hz, interval_s, kScale_s),
                  von_karman_density(frequency_hz * kScale_s) / all, 0.01)
          << interval_s << ' ' << cycles;
    }
  }
}

TEST(SampledTurbulence, NearlyAllIsTheWindsOwnFarBelowTheRateOfQuickSamples) {
  EXPECT_GT(von_karman_unfolded_part(0.02, 0.1, 8.0), 0.999);
  // At half of the rate, of waves of 1, 3, 5 ... times that frequency and as many below 0.
  EXPECT_NEAR(von_karman_unfolded_part(5.0, 0.1, 8.0), 0.347, 0.005);
  EXPECT_LT(von_karman_unfolded_part(0.0, 60.0, 8.0), 0.6);
}

}  // namespace
}  // namespace yuragi::wind::turbulence
