#include "engine/noise/vector_noise.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "tests/engine/noise/periodogram.hpp"

namespace yuragi::noise {
namespace {

constexpr Spec kOctaveSpec{.size = 64, .seed = 11, .from_cycles = 4.0, .to_cycles = 8.0};

VectorNoise2 turning_noise() {
  return VectorNoiseMaker().make(kOctaveSpec, true).value();
}

Tile2 turned_by(const Tile2& first, const Tile2& quarter, double angle_rad) {
  Tile2 tile = first;
  const auto cosine = static_cast<float>(std::cos(angle_rad));
  const auto sine = static_cast<float>(std::sin(angle_rad));
  for (std::size_t i = 0; i < tile.values.size(); ++i) {
    tile.values[i] = cosine * first.values[i] + sine * quarter.values[i];
  }
  return tile;
}

/// Of a tile with another one that is read (x, z) samples further on.
double likeness(const Tile2& a, const Tile2& b, std::size_t x, std::size_t z) {
  double sum = 0.0;
  for (std::size_t row = 0; row < a.size; ++row) {
    for (std::size_t column = 0; column < a.size; ++column) {
      sum += static_cast<double>(a.at(column, row) * b.at((column + x) % a.size, (row + z) % a.size));
    }
  }
  return sum / static_cast<double>(a.values.size());
}

TEST(VectorNoise, ComponentsHaveVarianceOneWhicheverWayTheyPoint) {
  const VectorNoise2 noise = turning_noise();
  for (const VectorTile2* tile : {&noise.first, &noise.quarter}) {
    EXPECT_NEAR(likeness(tile->x, tile->x, 0, 0), 1.0, 1e-5);
    EXPECT_NEAR(likeness(tile->z, tile->z, 0, 0), 1.0, 1e-5);
    EXPECT_NEAR(likeness(tile->x, tile->z, 0, 0), 0.0, 1e-5);
  }
}

/// Of the power of a ring's modes, in both components, the part that is along the wave vector: that of the scalar
/// noises alone, 3/8 of 3/8 + 3/8 + 1.
TEST(VectorNoise, LacksPowerAlongItsWaves) {
  double along = 0.0;
  double all = 0.0;
  VectorNoiseMaker maker;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    Spec spec = kOctaveSpec;
    spec.seed = seed;
    const VectorNoise2 noise = maker.make(spec, false).value();
    fft::RealFft x(2, spec.size);
    fft::RealFft z(2, spec.size);
    std::ranges::copy(noise.first.x.values, x.samples().begin());
    std::ranges::copy(noise.first.z.values, z.samples().begin());
    x.forward();
    z.forward();
    for (std::size_t i = 1; i < x.spectrum().size(); ++i) {
      const auto wave_x = static_cast<double>(i % x.row_modes());
      const std::size_t row = i / x.row_modes();
      const double wave_z = static_cast<double>(row) - (row > 32 ? 64.0 : 0.0);
      const double length = std::hypot(wave_x, wave_z);
      along += std::norm((wave_x * x.spectrum()[i] + wave_z * z.spectrum()[i]) / length);
      all += std::norm(x.spectrum()[i]) + std::norm(z.spectrum()[i]);
    }
  }
  EXPECT_NEAR(along / all, 3.0 / 14.0, 0.02);
}

TEST(VectorNoise, IsMoreLikeItselfAlongAComponentThanAcrossIt) {
  const VectorNoise2 noise = turning_noise();
  for (const std::size_t samples : {2U, 3U}) {
    EXPECT_GT(likeness(noise.first.x, noise.first.x, samples, 0),
              likeness(noise.first.x, noise.first.x, 0, samples) + 0.1);
    EXPECT_GT(likeness(noise.first.z, noise.first.z, 0, samples),
              likeness(noise.first.z, noise.first.z, samples, 0) + 0.1);
  }
}

TEST(VectorNoise, KeepsThePowerOfItsModesWhileItTurns) {
  const VectorNoise2 noise = turning_noise();
  const auto power_of = [&](double angle_rad) {
    std::vector<double> power = test::square_power(turned_by(noise.first.x, noise.quarter.x, angle_rad));
    const std::vector<double> of_z = test::square_power(turned_by(noise.first.z, noise.quarter.z, angle_rad));
    for (std::size_t i = 0; i < power.size(); ++i) power[i] += of_z[i];
    return power;
  };
  const std::vector<double> at_first = power_of(0.0);
  for (const double angle_rad : {0.5, 1.0, 0.5 * std::numbers::pi, 2.5, 4.0}) {
    const std::vector<double> now = power_of(angle_rad);
    for (std::size_t i = 1; i < now.size(); ++i) {
      // The two tiles are made unrelated and of variance 1 each by itself.
      ASSERT_NEAR(std::sqrt(now[i]), std::sqrt(at_first[i]), 0.15 * std::sqrt(at_first[i]) + 2e-3) << i;
    }
  }
}

TEST(VectorNoise, IsLikeItselfByTheCosineOfItsTurnAndStaysWhereItIs) {
  const VectorNoise2 noise = turning_noise();
  for (const double angle_rad : {0.0, 0.5, 1.0, 0.5 * std::numbers::pi, 3.0}) {
    const Tile2 now = turned_by(noise.first.x, noise.quarter.x, angle_rad);
    EXPECT_NEAR(likeness(noise.first.x, now, 0, 0), std::cos(angle_rad), 0.05);
    // A field that drifted would be more like its beginning on one side than on the other.
    EXPECT_NEAR(likeness(noise.first.x, now, 2, 0), likeness(noise.first.x, now, 62, 0), 0.3);
    EXPECT_NEAR(likeness(noise.first.x, now, 0, 2), likeness(noise.first.x, now, 0, 62), 0.3);
  }
}

TEST(VectorNoise, RefusesWhatItCannotMake) {
  VectorNoiseMaker maker;
  const auto error_of = [&](const Spec& spec) { return maker.make(spec, true).error(); };
  EXPECT_EQ(error_of({.size = 65}), Error::kSizeNotAllowed);
  EXPECT_EQ(error_of({.size = 64, .beta = -1.0}), Error::kBetaOutOfRange);
  EXPECT_EQ(error_of({.size = 64, .beta = 2.0, .from_cycles = 4.0, .to_cycles = 8.0}), Error::kBetaOutOfRange);
  EXPECT_EQ(error_of({.size = 64, .from_cycles = 40.0, .to_cycles = 80.0}), Error::kBandOutOfRange);
}

}  // namespace
}  // namespace yuragi::noise
