#include "engine/noise/turning_noise.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/engine/noise/periodogram.hpp"

namespace yuragi::noise {
namespace {

constexpr NoiseSpec kOctaveSpec{.size = 64, .seed = 11, .from_cycles = 4.0, .to_cycles = 8.0};

NoiseTile2 turned_by(const TurningNoise2& noise, double angle_rad) {
  NoiseTile2 tile = noise.first;
  const auto cosine = static_cast<float>(std::cos(angle_rad));
  const auto sine = static_cast<float>(std::sin(angle_rad));
  for (std::size_t i = 0; i < tile.values.size(); ++i) {
    tile.values[i] = cosine * noise.first.values[i] + sine * noise.quarter.values[i];
  }
  return tile;
}

/// Of a tile with another one that is read (x, z) samples further on.
double likeness(const NoiseTile2& a, const NoiseTile2& b, std::size_t x, std::size_t z) {
  double sum = 0.0;
  for (std::size_t row = 0; row < a.size; ++row) {
    for (std::size_t column = 0; column < a.size; ++column) {
      sum += static_cast<double>(a.at(column, row) * b.at((column + x) % a.size, (row + z) % a.size));
    }
  }
  return sum / static_cast<double>(a.values.size());
}

TEST(TurningNoise, BeginsAsThePlainNoise) {
  EXPECT_EQ(make_turning_noise_2d(kOctaveSpec).value().first.values, make_noise_2d(kOctaveSpec).value().values);
}

TEST(TurningNoise, KeepsEachModesPowerWhileItTurns) {
  const TurningNoise2 noise = make_turning_noise_2d(kOctaveSpec).value();
  const std::vector<double> at_first = test::square_power(noise.first);
  for (const double angle_rad : {0.5, 1.0, 0.5 * std::numbers::pi, 2.5, 4.0}) {
    const std::vector<double> now = test::square_power(turned_by(noise, angle_rad));
    for (std::size_t i = 1; i < now.size(); ++i) {
      ASSERT_NEAR(std::sqrt(now[i]), std::sqrt(at_first[i]), 1e-5 * std::sqrt(at_first[i]) + 2e-3) << i;
    }
  }
}

TEST(TurningNoise, IsLikeItselfByTheCosineOfItsTurnAndStaysWhereItIs) {
  const TurningNoise2 noise = make_turning_noise_2d(kOctaveSpec).value();
  for (const double angle_rad : {0.0, 0.5, 1.0, 0.5 * std::numbers::pi, 3.0}) {
    const NoiseTile2 now = turned_by(noise, angle_rad);
    EXPECT_NEAR(likeness(noise.first, now, 0, 0), std::cos(angle_rad), 1e-4);
    // A field that drifted would be more like its beginning on one side than on the other.
    EXPECT_NEAR(likeness(noise.first, now, 2, 0), likeness(noise.first, now, 62, 0), 0.25);
    EXPECT_NEAR(likeness(noise.first, now, 0, 2), likeness(noise.first, now, 0, 62), 0.25);
  }
}

TEST(TurningNoise, RefusesWhatThePlainNoiseRefuses) {
  EXPECT_EQ(make_turning_noise_2d({.size = 65}).error(), NoiseError::kSizeNotAllowed);
  EXPECT_EQ(make_turning_noise_2d({.size = 64, .beta = -1.0}).error(), NoiseError::kBetaOutOfRange);
}

}  // namespace
}  // namespace yuragi::noise
