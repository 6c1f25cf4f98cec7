#include "engine/wind/turbulence/von_karman.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "engine/noise/von_karman_corner.hpp"

namespace yuragi::wind::turbulence {
namespace {

TEST(VonKarmanTest, TheDensityIntegratesToOne) {
  // Over ln x by the trapezium rule, and the rest of the inertial range in closed form: 3/2 a x^(-2/3).
  constexpr double kStep = 0.001;
  constexpr double kTo = 1e4;
  double sum = 0.0;
  for (double log_x = std::log(1e-6); log_x < std::log(kTo); log_x += kStep) {
    const double x = std::exp(log_x);
    sum += x * von_karman_density(x) * kStep;
  }
  sum += 1.5 * von_karman_inertial_factor() * std::pow(kTo, -2.0 / 3.0);
  // The printed constant is rounded to three figures.
  EXPECT_NEAR(sum, 1.0, 3e-4);
}

TEST(VonKarmanTest, FarAboveTheBendItFallsAsTheInertialRange) {
  for (const double x : {30.0, 300.0, 3000.0}) {
    EXPECT_NEAR(von_karman_density(x) / (von_karman_inertial_factor() * std::pow(x, -5.0 / 3.0)), 1.0, 2e-5) << x;
  }
}

TEST(VonKarmanTest, TheCornerIsWhereTheDensityBends) {
  const double exact = std::tgamma(1.0 / 3.0) / (std::sqrt(std::numbers::pi) * std::tgamma(5.0 / 6.0));
  EXPECT_NEAR(noise::kVonKarmanCorner, exact, 5e-5);
  EXPECT_NEAR(std::pow(2.0 * std::numbers::pi * noise::kVonKarmanCorner, 2.0), kVonKarmanBend, 0.05);
}

}  // namespace
}  // namespace yuragi::wind::turbulence
