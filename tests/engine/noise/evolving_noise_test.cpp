#include "engine/noise/evolving_noise.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/engine/noise/periodogram.hpp"
#include "tests/support/bits.hpp"
#include "tests/support/each_simd_row.hpp"

namespace yuragi::noise {
namespace {

constexpr NoiseSpec kSpec{.size = 64, .seed = 5};

EvolvingNoise evolving(const NoiseSpec& spec = kSpec, double turn_rad_s = 1.0) {
  return EvolvingNoise::make(spec, turn_rad_s).value();
}

double variance_of(const NoiseTile2& tile) {
  double squares = 0.0;
  for (const float value : tile.values) squares += static_cast<double>(value) * static_cast<double>(value);
  return squares / static_cast<double>(tile.values.size());
}

/// Of a tile with another one that is read (x, z) samples further on.
double shifted_correlation(const NoiseTile2& a, const NoiseTile2& b, std::size_t x, std::size_t z) {
  double sum = 0.0;
  for (std::size_t row = 0; row < a.size; ++row) {
    for (std::size_t column = 0; column < a.size; ++column) {
      sum +=
          static_cast<double>(a.at(column, row)) * static_cast<double>(b.at((column + x) % a.size, (row + z) % a.size));
    }
  }
  return sum / static_cast<double>(a.values.size());
}

TEST(EvolvingNoiseTest, BeginsAsThePlainNoiseAndStaysItWhileNoTimePasses) {
  const auto plain = make_noise_2d(kSpec).value().values;
  EvolvingNoise noise = evolving();
  EXPECT_EQ(noise.tile().values, plain);
  noise.advance(0.0);
  EXPECT_EQ(noise.tile().values, plain);
  EvolvingNoise frozen = evolving(kSpec, 0.0);
  frozen.advance(1000.0);
  EXPECT_EQ(frozen.tile().values, plain);
}

TEST(EvolvingNoiseTest, KeepsItsSpectrumModeByModeAndSoItsVariance) {
  EvolvingNoise noise = evolving();
  const std::vector<double> at_first = test::square_power(noise.tile());
  for (int frame = 0; frame < 200; ++frame) {
    noise.advance(0.37);
    ASSERT_NEAR(variance_of(noise.tile()), 1.0, 1e-5);
    if (frame % 20 != 0) continue;
    // Column 0 and the middle column are where modes that were not turned as conjugate pairs would pulse. The rounding
    // of 4096 samples to 2^-20 is a power of 3e-10 in each mode.
    const std::vector<double> now = test::square_power(noise.tile());
    for (std::size_t i = 1; i < now.size(); ++i) {
      ASSERT_NEAR(std::sqrt(now[i]), std::sqrt(at_first[i]), 1e-5 * std::sqrt(at_first[i]) + 2e-4) << i;
    }
  }
}

TEST(EvolvingNoiseTest, ForgetsItsBeginning) {
  const NoiseSpec spec{.size = 128, .seed = 3, .integral_scale = 0.05};
  EvolvingNoise noise = evolving(spec);
  const NoiseTile2 at_first = noise.tile();
  double before = 1.0;
  for (int step = 0; step < 3; ++step) {
    noise.advance(0.15);
    const double now = shifted_correlation(at_first, noise.tile(), 0, 0);
    EXPECT_LT(now, before);
    before = now;
  }
  EXPECT_GT(before, 0.1);

  // And does not come back to it.
  noise.advance(2.0);
  for (int step = 0; step < 200; ++step) {
    noise.advance(0.5);
    ASSERT_LT(std::abs(shifted_correlation(at_first, noise.tile(), 0, 0)), 0.35);
  }
}

TEST(EvolvingNoiseTest, SmallEddiesTurnFasterThanLargeOnes) {
  // From one moment to another the modes around 16 cycles lose more of their likeness than those around 2: their rates
  // are as 4 to 1.
  EvolvingNoise noise = evolving({.size = 64, .beta = 1.0, .meaning = BetaMeaning::kRadial, .seed = 1}, 0.2);
  const auto modes_of = [](const NoiseTile2& tile) {
    fft::RealFft fft(2, tile.size);
    for (std::size_t i = 0; i < tile.values.size(); ++i) fft.samples()[i] = static_cast<double>(tile.values[i]);
    fft.forward();
    return std::vector<std::complex<double>>(fft.spectrum().begin(), fft.spectrum().end());
  };
  const auto before = modes_of(noise.tile());
  noise.advance(1.0);
  const auto after = modes_of(noise.tile());
  // Mode (kx, 0) is the kx-th.
  for (const std::size_t k : {1U, 2U, 8U, 16U, 27U}) {
    const double turned_rad = std::arg(after[k] / before[k]);
    EXPECT_NEAR(std::abs(turned_rad), 0.2 * std::cbrt(static_cast<double>(k * k)), 1e-4) << k;
  }
}

TEST(EvolvingNoiseTest, DoesNotDriftAsAWhole) {
  // What was here is found again, after some time, as much on the one side as on the other, averaged over fields.
  double east = 0.0;
  double west = 0.0;
  double south = 0.0;
  double north = 0.0;
  for (std::uint64_t seed = 0; seed < 32; ++seed) {
    EvolvingNoise noise = evolving({.size = 64, .seed = seed, .integral_scale = 0.05});
    const NoiseTile2 at_first = noise.tile();
    noise.advance(0.4);
    east += shifted_correlation(at_first, noise.tile(), 3, 0) / 32.0;
    west += shifted_correlation(at_first, noise.tile(), 61, 0) / 32.0;
    south += shifted_correlation(at_first, noise.tile(), 0, 3) / 32.0;
    north += shifted_correlation(at_first, noise.tile(), 0, 61) / 32.0;
  }
  EXPECT_NEAR(east, west, 0.08);
  EXPECT_NEAR(south, north, 0.08);
}

class EvolvingNoiseOnEachRow : public EachSimdRow {};
YURAGI_ON_EACH_ROW(EvolvingNoiseOnEachRow);

TEST_P(EvolvingNoiseOnEachRow, HasTheSameBits) {
  EvolvingNoise base = EvolvingNoise::make(kSpec, 1.0, kBaseSimdRow).value();
  EvolvingNoise noise = EvolvingNoise::make(kSpec, 1.0, GetParam()).value();
  for (int frame = 0; frame < 20; ++frame) {
    base.advance(1.0 / 60.0);
    noise.advance(1.0 / 60.0);
    ASSERT_EQ(bits_of(noise.tile().values), bits_of(base.tile().values));
  }
}

TEST(EvolvingNoiseTest, StandsOnTheGridAndIsDeterministic) {
  EvolvingNoise one = evolving();
  EvolvingNoise other = evolving();
  for (int frame = 0; frame < 20; ++frame) {
    one.advance(1.0 / 60.0);
    other.advance(1.0 / 60.0);
  }
  EXPECT_EQ(one.tile().values, other.tile().values);
  for (const float value : one.tile().values) {
    const double steps = static_cast<double>(value) * 0x1p20;
    ASSERT_EQ(steps, std::nearbyint(steps));
  }
}

TEST(EvolvingNoiseTest, ManyShortStepsEndWhereOneLongOneDoes) {
  EvolvingNoise one = evolving();
  EvolvingNoise many = evolving();
  one.advance(10.0);
  for (int i = 0; i < 600; ++i) many.advance(1.0 / 60.0);
  for (std::size_t i = 0; i < one.tile().values.size(); ++i) {
    ASSERT_NEAR(one.tile().values[i], many.tile().values[i], 1e-5F);
  }
}

TEST(EvolvingNoiseTest, RefusesWhatThePlainNoiseRefusesAndATurnOutOfRange) {
  EXPECT_EQ(EvolvingNoise::make({.size = 7}, 1.0).error(), NoiseError::kSizeNotAllowed);
  EXPECT_EQ(EvolvingNoise::make({.size = 8, .beta = -1.0}, 1.0).error(), NoiseError::kBetaOutOfRange);
  for (const double turn : {-0.1, 100.1, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(static_cast<void>(EvolvingNoise::make(kSpec, turn)), std::invalid_argument);
  }
}

}  // namespace
}  // namespace yuragi::noise
