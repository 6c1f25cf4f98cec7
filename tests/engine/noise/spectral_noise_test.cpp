#include "engine/noise/spectral_noise.hpp"

#include <bit>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/engine/noise/periodogram.hpp"

namespace yuragi::noise {
namespace {

struct Moments {
  double mean;
  double variance;
};

Moments moments_of(const std::vector<float>& values) {
  double sum = 0.0;
  double squares = 0.0;
  for (const float value : values) {
    sum += static_cast<double>(value);
    squares += static_cast<double>(value) * static_cast<double>(value);
  }
  const double mean = sum / static_cast<double>(values.size());
  return {mean, squares / static_cast<double>(values.size()) - mean * mean};
}

double correlation(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += static_cast<double>(a[i]) * static_cast<double>(b[i]);
  return sum / static_cast<double>(a.size());
}

double squared_difference(float a, float b) {
  const double difference = static_cast<double>(a) - static_cast<double>(b);
  return difference * difference;
}

/// FNV-1a, 64 bits, over the bytes of the values, the least significant first.
std::uint64_t hash_of(const std::vector<float>& values) {
  std::uint64_t hash = 14695981039346656037U;
  for (const float value : values) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    for (unsigned shift = 0; shift < 32; shift += 8) hash = (hash ^ ((bits >> shift) & 0xffU)) * 1099511628211U;
  }
  return hash;
}

TEST(SpectralNoise, TransectAddsOneToTheExponentForEachDimensionBeyondTheFirst) {
  EXPECT_DOUBLE_EQ(mode_exponent(1, 5.0 / 3.0, BetaMeaning::kTransect), 5.0 / 3.0);
  EXPECT_DOUBLE_EQ(mode_exponent(2, 5.0 / 3.0, BetaMeaning::kTransect), 8.0 / 3.0);
  EXPECT_DOUBLE_EQ(mode_exponent(3, 5.0 / 3.0, BetaMeaning::kTransect), 11.0 / 3.0);
  for (int dims = 1; dims <= 3; ++dims) EXPECT_DOUBLE_EQ(mode_exponent(dims, 1.5, BetaMeaning::kRadial), 1.5);
}

TEST(SpectralNoise, HasMeanZeroAndVarianceOne) {
  for (const double beta : {0.0, 5.0 / 3.0, 8.0}) {
    const BetaMeaning meaning = beta == 0.0 ? BetaMeaning::kRadial : BetaMeaning::kTransect;
    const Moments cube =
        moments_of(make_noise_3d({.size = 32, .beta = beta, .meaning = meaning, .seed = 3}).value().values);
    EXPECT_NEAR(cube.mean, 0.0, 0x1p-20);
    EXPECT_NEAR(cube.variance, 1.0, 0x1p-18);
    for (const std::size_t size : {std::size_t{8}, std::size_t{64}, std::size_t{256}}) {
      const Moments line = moments_of(make_noise_1d({.size = size, .beta = beta, .seed = 3}).value().values);
      const Moments square =
          moments_of(make_noise_2d({.size = size, .beta = beta, .meaning = meaning, .seed = 3}).value().values);
      for (const Moments moments : {line, square}) {
        EXPECT_NEAR(moments.mean, 0.0, 0x1p-20);
        EXPECT_NEAR(moments.variance, 1.0, 0x1p-18);
      }
    }
  }
}

TEST(SpectralNoise, StandsOnTheGrid) {
  for (const float value :
       make_noise_2d({.size = 128, .beta = 0.0, .meaning = BetaMeaning::kRadial, .seed = 4}).value().values) {
    const double steps = static_cast<double>(value) * 0x1p20;
    ASSERT_EQ(steps, std::nearbyint(steps));
  }
}

TEST(SpectralNoise, SameSpecGivesTheSameBitsAndEachPartOfItMatters) {
  const Spec spec{.size = 64, .seed = 5};
  EXPECT_EQ(make_noise_1d(spec).value().values, make_noise_1d(spec).value().values);
  EXPECT_EQ(make_noise_2d(spec).value().values, make_noise_2d(spec).value().values);

  Spec other_seed = spec;
  other_seed.seed = 6;
  Spec other_beta = spec;
  other_beta.beta = 1.5;
  Spec other_meaning = spec;
  other_meaning.meaning = BetaMeaning::kRadial;
  for (const Spec& other : {other_seed, other_beta, other_meaning}) {
    EXPECT_NE(make_noise_2d(spec).value().values, make_noise_2d(other).value().values);
  }
}

TEST(SpectralNoise, SmallTilesHaveTheirGoldenBits) {
  EXPECT_EQ(hash_of(make_noise_1d({.size = 64, .seed = 1}).value().values), 5157284792099184044U);
  EXPECT_EQ(hash_of(make_noise_3d({.size = 8, .seed = 1}).value().values), 1302879074528231250U);
  EXPECT_EQ(hash_of(make_noise_2d({.size = 16, .seed = 1}).value().values), 12415000308388288477U);
}

TEST(SpectralNoise, DifferentSeedsAreUncorrelated) {
  // Beta 0, so that the samples count as independent: a standard error of 1 / sqrt(4096).
  const auto reference_1 = make_noise_1d({.size = 4096, .beta = 0.0, .seed = 0}).value().values;
  const auto reference_2 =
      make_noise_2d({.size = 64, .beta = 0.0, .meaning = BetaMeaning::kRadial, .seed = 0}).value().values;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    const auto line = make_noise_1d({.size = 4096, .beta = 0.0, .seed = seed}).value().values;
    const auto square =
        make_noise_2d({.size = 64, .beta = 0.0, .meaning = BetaMeaning::kRadial, .seed = seed}).value().values;
    EXPECT_NEAR(correlation(reference_1, line), 0.0, 4.0 / 64.0);
    EXPECT_NEAR(correlation(reference_2, square), 0.0, 4.0 / 64.0);
  }
}

TEST(SpectralNoise, ALineAndASquareOfOneSeedAreUncorrelated) {
  const auto line = make_noise_1d({.size = 4096, .beta = 0.0, .seed = 9}).value().values;
  const auto square =
      make_noise_2d({.size = 64, .beta = 0.0, .meaning = BetaMeaning::kRadial, .seed = 9}).value().values;
  EXPECT_NEAR(correlation(line, square), 0.0, 4.0 / 64.0);
}

TEST(SpectralNoise, ALineHasNoSeam) {
  // The squared jump from the last sample to the first, against that between neighbours, over 64 seeds: a mean of 64
  // chi-squared values scatters by sqrt(2 / 64) = 0.18.
  double seam = 0.0;
  double inside = 0.0;
  for (std::uint64_t seed = 0; seed < 64; ++seed) {
    const auto values = make_noise_1d({.size = 256, .seed = seed}).value().values;
    seam += squared_difference(values.back(), values.front());
    for (std::size_t i = 0; i + 1 < values.size(); ++i) inside += squared_difference(values[i], values[i + 1]) / 255.0;
  }
  EXPECT_NEAR(seam / inside, 1.0, 4.0 * 0.18);
}

TEST(SpectralNoise, ACubeHasNoSeamInAnyDirection) {
  constexpr std::size_t kSize = 32;
  double seam[3] = {};
  double inside = 0.0;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const auto tile = make_noise_3d({.size = kSize, .seed = seed}).value();
    for (std::size_t i = 0; i < kSize; ++i) {
      for (std::size_t j = 0; j < kSize; ++j) {
        seam[0] += squared_difference(tile.at(kSize - 1, i, j), tile.at(0, i, j));
        seam[1] += squared_difference(tile.at(i, kSize - 1, j), tile.at(i, 0, j));
        seam[2] += squared_difference(tile.at(i, j, kSize - 1), tile.at(i, j, 0));
        for (std::size_t x = 0; x + 1 < kSize; ++x) {
          inside += squared_difference(tile.at(x, i, j), tile.at(x + 1, i, j)) / static_cast<double>(kSize - 1);
        }
      }
    }
  }
  for (const double each : seam) EXPECT_NEAR(each / inside, 1.0, 0.25);
}

TEST(SpectralNoise, NoModeOfACubeLosesPowerToASpectrumThatIsNotHermitian) {
  // As for the square below: white noise, of which the planes kx = 0 and size / 2 hold both of each pair.
  constexpr std::size_t kSize = 8;
  constexpr std::size_t kHalf = kSize / 2;
  constexpr int kSeeds = 64;
  double plane = 0.0;
  double inner = 0.0;
  fft::RealFft fft(3, kSize);
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const auto tile =
        make_noise_3d({.size = kSize, .beta = 0.0, .meaning = BetaMeaning::kRadial, .seed = seed}).value();
    for (std::size_t i = 0; i < tile.values.size(); ++i) fft.samples()[i] = static_cast<double>(tile.values[i]);
    fft.forward();
    for (std::size_t row = 1; row < kSize * kSize; ++row) {
      plane += std::norm(fft.spectrum()[row * (kHalf + 1)]) / 2.0;
      plane += std::norm(fft.spectrum()[row * (kHalf + 1) + kHalf]) / 2.0;
      for (std::size_t x = 1; x < kHalf; ++x) inner += std::norm(fft.spectrum()[row * (kHalf + 1) + x]) / (kHalf - 1);
    }
  }
  // A mean of 64 x 63 exponential values: 1.6 %.
  EXPECT_NEAR(plane / inner, 1.0, 4.0 * 0.02);
}

TEST(SpectralNoise, ASquareHasNoSeamInEitherDirection) {
  constexpr std::size_t kSize = 128;
  double seam_x = 0.0;
  double seam_z = 0.0;
  double inside = 0.0;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const auto tile = make_noise_2d({.size = kSize, .seed = seed}).value();
    for (std::size_t i = 0; i < kSize; ++i) {
      seam_x += squared_difference(tile.at(kSize - 1, i), tile.at(0, i));
      seam_z += squared_difference(tile.at(i, kSize - 1), tile.at(i, 0));
      for (std::size_t x = 0; x + 1 < kSize; ++x) {
        inside += squared_difference(tile.at(x, i), tile.at(x + 1, i)) / static_cast<double>(kSize - 1);
      }
    }
  }
  EXPECT_NEAR(seam_x / inside, 1.0, 0.25);
  EXPECT_NEAR(seam_z / inside, 1.0, 0.25);
}

TEST(SpectralNoise, NoModeLosesPowerToASpectrumThatIsNotHermitian) {
  // White noise: every mode has the same mean power. Modes in column 0 and the middle column that were not made
  // conjugate pairs would come back with half of it, and so would self-mirrored ones whose imaginary part was dropped.
  constexpr std::size_t kSize = 32;
  constexpr std::size_t kHalf = kSize / 2;
  constexpr int kSeeds = 64;
  double first = 0.0;
  double middle = 0.0;
  double inner = 0.0;
  double own_mirror = 0.0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const auto power = test::square_power(
        make_noise_2d({.size = kSize, .beta = 0.0, .meaning = BetaMeaning::kRadial, .seed = seed}).value());
    const auto at = [&](std::size_t x, std::size_t z) { return power[z * (kHalf + 1) + x]; };
    EXPECT_LT(at(0, 0), 1e-6);
    own_mirror += (at(kHalf, 0) + at(0, kHalf) + at(kHalf, kHalf)) / 3.0;
    for (std::size_t z = 1; z < kSize; ++z) {
      if (z == kHalf) continue;
      first += at(0, z) / (kSize - 2);
      middle += at(kHalf, z) / (kSize - 2);
      for (std::size_t x = 1; x < kHalf; ++x) inner += at(x, z) / ((kSize - 2) * (kHalf - 1));
    }
  }
  // Means of 64 x 15 exponential values (3.2 %) and of 64 x 3 chi-squared ones (10 %).
  EXPECT_NEAR(first / inner, 1.0, 4.0 * 0.032);
  EXPECT_NEAR(middle / inner, 1.0, 4.0 * 0.032);
  EXPECT_NEAR(own_mirror / inner, 1.0, 4.0 * 0.10);
}

TEST(SpectralNoise, ALinesHighestModeHasTheSamePowerAsItsNeighbours) {
  double highest = 0.0;
  double inner = 0.0;
  for (std::uint64_t seed = 0; seed < 256; ++seed) {
    const auto power = test::line_power(make_noise_1d({.size = 64, .beta = 0.0, .seed = seed}).value());
    highest += power[32];
    for (std::size_t k = 1; k < 32; ++k) inner += power[k] / 31.0;
  }
  EXPECT_NEAR(highest / inner, 1.0, 4.0 * std::sqrt(2.0 / 256.0));
}

TEST(SpectralNoise, ALargerTileOfTheSameSeedRepeatsTheLargeWavesOfASmallerOne) {
  const auto small = test::line_power(make_noise_1d({.size = 64, .seed = 11}).value());
  const auto large = test::line_power(make_noise_1d({.size = 512, .seed = 11}).value());
  for (std::size_t k = 2; k < 32; ++k)
    EXPECT_NEAR(large[k] / large[1], small[k] / small[1], 1e-4 * small[k] / small[1]);
}

TEST(SpectralNoise, RefusesASizeThatIsNotAllowed) {
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{4}, std::size_t{12}, std::size_t{100},
                                 kMaxNoiseSize1 * 2, std::numeric_limits<std::size_t>::max()}) {
    EXPECT_EQ(make_noise_1d({.size = size}).error(), Error::kSizeNotAllowed) << size;
    EXPECT_EQ(make_noise_2d({.size = size}).error(), Error::kSizeNotAllowed) << size;
    EXPECT_EQ(make_noise_3d({.size = size}).error(), Error::kSizeNotAllowed) << size;
  }
  EXPECT_EQ(make_noise_2d({.size = kMaxNoiseSize2 * 2}).error(), Error::kSizeNotAllowed);
  EXPECT_EQ(make_noise_3d({.size = kMaxNoiseSize3 * 2}).error(), Error::kSizeNotAllowed);
}

TEST(SpectralNoise, RefusesABetaOutOfRange) {
  for (const double beta : {-0.001, 8.001, std::numeric_limits<double>::quiet_NaN(),
                            std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(make_noise_1d({.size = 64, .beta = beta}).error(), Error::kBetaOutOfRange) << beta;
    EXPECT_EQ(make_noise_2d({.size = 64, .beta = beta}).error(), Error::kBetaOutOfRange) << beta;
  }
}

TEST(SpectralNoise, RefusesATransectThatIsFlatterThanATileCanHave) {
  for (const double beta : {0.0, 0.3, 0.599}) {
    EXPECT_EQ(make_noise_2d({.size = 64, .beta = beta}).error(), Error::kTransectTooFlat) << beta;
    EXPECT_TRUE(make_noise_2d({.size = 64, .beta = beta, .meaning = BetaMeaning::kRadial}).has_value()) << beta;
  }
  for (const double beta : {0.0, 0.6, 0.999}) {
    EXPECT_EQ(make_noise_3d({.size = 8, .beta = beta}).error(), Error::kTransectTooFlat) << beta;
    EXPECT_TRUE(make_noise_3d({.size = 8, .beta = beta, .meaning = BetaMeaning::kRadial}).has_value()) << beta;
    EXPECT_TRUE(make_noise_1d({.size = 64, .beta = beta}).has_value()) << beta;
  }
  EXPECT_TRUE(make_noise_2d({.size = 64, .beta = kMinTransectBeta2}).has_value());
  EXPECT_TRUE(make_noise_3d({.size = 8, .beta = kMinTransectBeta3}).has_value());
}

TEST(SpectralNoise, RefusesAnIntegralScaleThatIsNone) {
  for (const double scale : {-1.0, 0.9e-6, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(make_noise_1d({.size = 64, .integral_scale = scale}).error(), Error::kIntegralScaleOutOfRange);
    EXPECT_EQ(make_noise_3d({.size = 8, .integral_scale = scale}).error(), Error::kIntegralScaleOutOfRange);
  }
}

TEST(SpectralNoise, WithoutAnIntegralScaleOrWithAnEndlessOneIsThePurePowerLaw) {
  const auto pure = make_noise_2d({.size = 32, .seed = 8}).value().values;
  for (const double scale : {std::numeric_limits<double>::infinity(), 1e200}) {
    EXPECT_EQ(make_noise_2d({.size = 32, .seed = 8, .integral_scale = scale}).value().values, pure);
  }
  EXPECT_NE(make_noise_2d({.size = 32, .seed = 8, .integral_scale = 0.5}).value().values, pure);
}

TEST(SpectralNoise, TheSmallestIntegralScaleIsWhiteNoise) {
  const Tile2 tile = make_noise_2d({.size = 64, .beta = 8.0, .integral_scale = kMinNoiseIntegralScale}).value();
  EXPECT_NEAR(moments_of(tile.values).variance, 1.0, 0x1p-18);
  EXPECT_NEAR(test::falling_exponent(test::ring_power(tile), 4, 32), 0.0, 0.15);
}

TEST(SpectralNoise, EveryErrorHasANameAndAnExplanationThatAnUncheckedCallerGets) {
  EXPECT_EQ(name_of(Error::kSizeNotAllowed), "size-not-allowed");
  EXPECT_EQ(name_of(Error::kBetaOutOfRange), "beta-out-of-range");
  EXPECT_EQ(name_of(Error::kTransectTooFlat), "transect-too-flat");
  EXPECT_EQ(name_of(Error::kIntegralScaleOutOfRange), "integral-scale-out-of-range");
  try {
    static_cast<void>(make_noise_1d({.size = 7}).value());
    FAIL() << "should have thrown";
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(error.what(), explain(Error::kSizeNotAllowed));
  }
}

}  // namespace
}  // namespace yuragi::noise
