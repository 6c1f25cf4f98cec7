// The power laws of the noise, measured by plain periodograms of the periodic field, least squares in
// log-log. In one dimension a seed scatters by 0.06 (N = 4096: pi / sqrt(6) over the root of 509 values of ln k of
// standard deviation 1), in two by 0.05 (256^2) or 0.025 (512^2).

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "engine/noise/spectral_noise.hpp"
#include "tests/engine/noise/periodogram.hpp"

namespace yuragi::noise {
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

/// The exponent that the line cuts of a square or cube with modes |k|^-(beta + dims - 1) have on average over seeds:
/// for each wave number along the line, the sum over the modes beside it.
double exponent_of_cuts(int dims, std::size_t size, double beta) {
  const double exponent = mode_exponent(dims, beta, BetaMeaning::kTransect);
  const auto half = static_cast<std::int64_t>(size / 2);
  const std::int64_t deepest = dims == 3 ? half : 0;
  std::vector<double> power(size / 16 + 1, 0.0);
  for (std::size_t x = 1; x < power.size(); ++x) {
    for (std::int64_t z = 0; z <= half; ++z) {
      for (std::int64_t y = 0; y <= deepest; ++y) {
        const double mirrored = (z == 0 || z == half ? 1.0 : 2.0) * (y == 0 || y == half ? 1.0 : 2.0);
        const auto beside = static_cast<double>(z * z + y * y);
        power[x] += mirrored * std::pow(static_cast<double>(x * x) + beside, -0.5 * exponent);
      }
    }
  }
  return test::falling_exponent(power, 4, size / 16);
}

TEST(NoiseSlope, ATransectOfTheLeastBetaIsATenthTooSteepAndAFlatterOneIsNoLongerWhatWasAskedFor) {
  for (const std::size_t size : {std::size_t{512}, std::size_t{1024}}) {
    EXPECT_NEAR(exponent_of_cuts(2, size, kMinTransectBeta2), kMinTransectBeta2, 0.1) << size;
    EXPECT_GT(exponent_of_cuts(2, size, 0.0), 0.25) << size;
  }
  EXPECT_NEAR(exponent_of_cuts(3, 256, kMinTransectBeta3), kMinTransectBeta3, 0.1);
  EXPECT_GT(exponent_of_cuts(3, 256, 0.0), 0.35);

  // What is made is what was computed; 4 seeds.
  std::vector<double> mean(512 / 2 + 1, 0.0);
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    const std::vector<double> power =
        test::row_power(make_noise_2d({.size = 512, .beta = kMinTransectBeta2, .seed = seed}).value());
    for (std::size_t k = 0; k < mean.size(); ++k) mean[k] += power[k];
  }
  EXPECT_NEAR(test::falling_exponent(mean, 4, 512 / 16), exponent_of_cuts(2, 512, kMinTransectBeta2), 0.05);
}

TEST(NoiseSlope, TransectSquareOfOneSeedFallsAsBetaAlongItsRows) {
  constexpr std::size_t kSize = 1024;
  for (const double beta : {1.0, 5.0 / 3.0, 2.0}) {
    const auto tile = make_noise_2d({.size = kSize, .beta = beta, .seed = 7}).value();
    EXPECT_NEAR(test::falling_exponent(test::row_power(tile), 4, kSize / 16), beta, 0.1) << "beta " << beta;
  }
}

TEST(NoiseSlope, RadialCubeFallsAsBetaAroundTheOrigin) {
  constexpr std::size_t kSize = 64;
  constexpr int kSeeds = 16;
  for (const double beta : {0.0, 5.0 / 3.0, 11.0 / 3.0}) {
    double sum = 0.0;
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      const auto tile =
          make_noise_3d({.size = kSize, .beta = beta, .meaning = BetaMeaning::kRadial, .seed = seed}).value();
      const double measured = test::falling_exponent(test::shell_power(tile), 4, kSize / 2);
      EXPECT_NEAR(measured, beta, 0.10) << "seed " << seed;
      sum += measured;
    }
    EXPECT_NEAR(sum / kSeeds, beta, 0.03) << "beta " << beta;
  }
}

TEST(NoiseSlope, TransectCubeFallsAsBetaAlongItsRows) {
  constexpr std::size_t kSize = 128;
  constexpr int kSeeds = 4;
  for (const double beta : {1.0, 5.0 / 3.0, 2.0}) {
    std::vector<double> mean(kSize / 2 + 1, 0.0);
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      const auto tile = make_noise_3d({.size = kSize, .beta = beta, .seed = seed}).value();
      const std::vector<double> power = test::row_power(tile);
      for (std::size_t k = 0; k < mean.size(); ++k) mean[k] += power[k];
    }
    EXPECT_NEAR(test::falling_exponent(mean, 4, kSize / 16), beta, 0.1) << "beta " << beta;
  }
}

/// The integral of the correlation along rows over five times the scale that is expected, as a part of the edge.
double integral_scale_of(const std::vector<double>& row_power, double expected) {
  const std::size_t size = 2 * (row_power.size() - 1);
  fft::RealFft fft(1, size);
  for (std::size_t k = 0; k < row_power.size(); ++k) fft.spectrum()[k] = row_power[k];
  fft.inverse();
  const double variance = fft.samples()[0];
  double sum = 0.5 * variance;
  const auto lags = static_cast<std::size_t>(5.0 * expected * static_cast<double>(size));
  for (std::size_t lag = 1; lag <= lags; ++lag) sum += fft.samples()[lag];
  return sum / variance / static_cast<double>(size);
}

TEST(NoiseSlope, TheIntegralScaleIsThatOfALineAndOfALineCut) {
  // A line 512 L long scatters by about 14 %, so sixteen by 4 %; there are 128 samples in L.
  constexpr double kLineScale = 1.0 / 512.0;
  constexpr int kSeeds = 16;
  double line = 0.0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const auto tile = make_noise_1d({.size = 65536, .seed = seed, .integral_scale = kLineScale}).value();
    line += integral_scale_of(test::line_power(tile), kLineScale) / kSeeds;
  }
  EXPECT_NEAR(line / kLineScale, 1.0, 0.1);

  // 32 samples in L: what is finer than a sample, and missing, would make 3 % of the variance.
  constexpr double kSquareScale = 1.0 / 64.0;
  const auto square = make_noise_2d({.size = 2048, .seed = 1, .integral_scale = kSquareScale}).value();
  EXPECT_NEAR(integral_scale_of(test::row_power(square), kSquareScale) / kSquareScale, 1.0, 0.08);
}

TEST(NoiseSlope, ALineCutOfACubeHasVonKarmansSpectrum) {
  constexpr std::size_t kSize = 128;
  constexpr double kScale = 1.0 / 16.0;
  std::vector<double> against(kSize / 2 + 1, 0.0);
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    const auto tile = make_noise_3d({.size = kSize, .seed = seed, .integral_scale = kScale}).value();
    const std::vector<double> power = test::row_power(tile);
    const double corner = 1.0 / (2.0 * std::numbers::pi * 1.339 * kScale);
    for (std::size_t k = 0; k < power.size(); ++k) {
      against[k] += power[k] * std::pow(corner * corner + static_cast<double>(k * k), 5.0 / 6.0);
    }
  }
  EXPECT_NEAR(test::falling_exponent(against, 1, kSize / 8), 0.0, 0.1);
}

TEST(NoiseSlope, WavesShorterThanTheIntegralScaleKeepTheirSlope) {
  constexpr std::size_t kSize = 1024;
  const auto tile = make_noise_2d({.size = kSize, .seed = 7, .integral_scale = 0.25}).value();
  EXPECT_NEAR(test::falling_exponent(test::row_power(tile), 4, kSize / 16), 5.0 / 3.0, 0.1);
}

TEST(NoiseSlope, RadialSquareOfFiveThirdsIsFarRougherAlongItsRowsThanWind) {
  constexpr std::size_t kSize = 512;
  const auto tile = make_noise_2d({.size = kSize, .meaning = BetaMeaning::kRadial, .seed = 1}).value();
  const double measured = test::falling_exponent(test::row_power(tile), 4, kSize / 16);
  EXPECT_GT(measured, 0.6);
  EXPECT_LT(measured, 0.95);
}

}  // namespace
}  // namespace yuragi::noise
