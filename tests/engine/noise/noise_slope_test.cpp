// The power laws of the noise, measured as wind.md 5 says: plain periodograms of the periodic field, least squares in
// log-log. In one dimension a seed scatters by 0.06 (N = 4096: pi / sqrt(6) over the root of 509 values of ln k of
// standard deviation 1), in two by 0.05 (256^2) or 0.025 (512^2).

#include <gtest/gtest.h>

#include "engine/noise/spectral_noise.hpp"
#include "tests/engine/noise/periodogram.hpp"

namespace yuragi {
namespace {

constexpr double kBetas[] = {0.0, 1.0, 5.0 / 3.0, 3.0};

TEST(NoiseSlope, ALineFallsAsBetaForEachSeedAndMoreCloselyOnAverage) {
  constexpr std::size_t kSize = 4096;
  constexpr int kSeeds = 16;
  for (const double beta : kBetas) {
    double sum = 0.0;
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      const auto tile = make_noise_1d({.size = kSize, .beta = beta, .seed = seed}).value();
      const double measured = test::falling_exponent(test::line_power(tile), 4, kSize / 8);
      EXPECT_NEAR(measured, beta, 3.5 * 0.06) << "seed " << seed;
      sum += measured;
    }
    EXPECT_NEAR(sum / kSeeds, beta, 3.0 * 0.06 / 4.0) << "beta " << beta;
  }
}

TEST(NoiseSlope, RadialSquareFallsAsBetaAroundTheOrigin) {
  constexpr std::size_t kSize = 512;
  for (const double beta : kBetas) {
    const auto tile = make_noise_2d({.size = kSize, .beta = beta, .meaning = BetaMeaning::kRadial, .seed = 7}).value();
    EXPECT_NEAR(test::falling_exponent(test::ring_power(tile), 4, kSize / 4), beta, 0.10) << "beta " << beta;
  }
}

TEST(NoiseSlope, RadialSquaresOfSixteenSeedsFallAsBetaWithinThreeHundredths) {
  constexpr std::size_t kSize = 256;
  constexpr int kSeeds = 16;
  for (const double beta : {5.0 / 3.0, 8.0 / 3.0}) {
    double sum = 0.0;
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      const auto tile =
          make_noise_2d({.size = kSize, .beta = beta, .meaning = BetaMeaning::kRadial, .seed = seed}).value();
      sum += test::falling_exponent(test::ring_power(tile), 4, kSize / 4);
    }
    EXPECT_NEAR(sum / kSeeds, beta, 0.03);
  }
}

TEST(NoiseSlope, TransectSquareFallsAsBetaAlongItsRows) {
  constexpr std::size_t kSize = 512;
  constexpr int kSeeds = 4;
  for (const double beta : {1.0, 5.0 / 3.0, 2.0}) {
    std::vector<double> mean(kSize / 2 + 1, 0.0);
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      const auto tile = make_noise_2d({.size = kSize, .beta = beta, .seed = seed}).value();
      const std::vector<double> power = test::row_power(tile);
      for (std::size_t k = 0; k < mean.size(); ++k) mean[k] += power[k];
    }
    EXPECT_NEAR(test::falling_exponent(mean, 4, kSize / 16), beta, 0.1) << "beta " << beta;
  }
}

TEST(NoiseSlope, RadialSquareOfFiveThirdsIsFarRougherAlongItsRowsThanWind) {
  constexpr std::size_t kSize = 512;
  const auto tile = make_noise_2d({.size = kSize, .meaning = BetaMeaning::kRadial, .seed = 1}).value();
  const double measured = test::falling_exponent(test::row_power(tile), 4, kSize / 16);
  EXPECT_GT(measured, 0.6);
  EXPECT_LT(measured, 0.95);
}

}  // namespace
}  // namespace yuragi
