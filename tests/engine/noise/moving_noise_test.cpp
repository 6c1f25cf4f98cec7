#include "engine/noise/moving_noise.hpp"

#include <cmath>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace yuragi::noise {
namespace {

/// Unequal along the axes, so that a mixed-up axis shows.
double uneven_power(double x, double z, double y) {
  return std::pow(1.0 + x * x + 2.0 * z * z + 3.0 * y * y, -2.0);
}

MovingNoise moving(int dims, std::size_t size, std::uint64_t seed = 3) {
  const std::vector<MovingField> fields = {{uneven_power, seed}, {uneven_power, seed + 1}};
  return {dims, size, fields};
}

std::vector<float> copy_of(std::span<const float> samples) {
  return {samples.begin(), samples.end()};
}

double mean_product(std::span<const float> a, std::span<const float> b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += static_cast<double>(a[i]) * static_cast<double>(b[i]);
  return sum / static_cast<double>(a.size());
}

class MovingNoiseDims : public testing::TestWithParam<int> {};

TEST_P(MovingNoiseDims, IsReadWhereItHasNotBeenYet) {
  // Carried by (3, 5, 2) samples it has at a place what it had at the place less that.
  constexpr std::size_t kSize = 16;
  MovingNoise noise = moving(GetParam(), kSize);
  const std::vector<float> before = copy_of(noise.samples(0));
  noise.move_to({3.0 / kSize, 5.0 / kSize, 2.0 / kSize}, 0.0);
  for (std::size_t y = 0; y < (GetParam() == 3 ? kSize : 1); ++y) {
    for (std::size_t z = 0; z < kSize; ++z) {
      for (std::size_t x = 0; x < kSize; ++x) {
        const std::size_t from_y = GetParam() == 3 ? (y + kSize - 2) % kSize : 0;
        const std::size_t from = (from_y * kSize + (z + kSize - 5) % kSize) * kSize + (x + kSize - 3) % kSize;
        ASSERT_NEAR(noise.samples(0)[(y * kSize + z) * kSize + x], before[from], 1e-5);
      }
    }
  }
}

TEST_P(MovingNoiseDims, ReadsItsSamplesAndBetweenThemAroundTheTorus) {
  constexpr std::size_t kSize = 8;
  const MovingNoise noise = moving(GetParam(), kSize);
  EXPECT_FLOAT_EQ(static_cast<float>(noise.read(1, {3.0 / kSize, 6.0 / kSize, 0.0})), noise.samples(1)[6 * kSize + 3]);
  const float last = noise.samples(1)[7];
  const float first = noise.samples(1)[0];
  EXPECT_NEAR(noise.read(1, {-0.25 / kSize, 2.0, -1.0}), 0.75F * first + 0.25F * last, 1e-5);
  EXPECT_TRUE(std::isfinite(noise.read(1, {-1e-20, 1.0 - 1e-17, -1e-20})));
}

TEST_P(MovingNoiseDims, KeepsItsVarianceAndForgetsItsBeginningWhileItTurns) {
  MovingNoise noise = moving(GetParam(), 32);
  const std::vector<float> before = copy_of(noise.samples(0));
  const double variance = mean_product(before, before);
  double likeness = 1.0;
  for (const double turn_rad : {0.3, 0.6, 0.9}) {
    noise.move_to({0.0, 0.0, 0.0}, turn_rad);
    EXPECT_NEAR(mean_product(noise.samples(0), noise.samples(0)), variance, 1e-4 * variance);
    const double now = mean_product(before, noise.samples(0)) / variance;
    EXPECT_LT(now, likeness - 0.02);
    likeness = now;
  }
  // And goes back when time does, but for rounding.
  noise.move_to({0.0, 0.0, 0.0}, 0.0);
  EXPECT_EQ(copy_of(noise.samples(0)), before);
}

TEST_P(MovingNoiseDims, HasTheVarianceOfItsPowersOnAverageOverSeeds) {
  double measured = 0.0;
  double expected = 0.0;
  for (std::uint64_t seed = 0; seed < 200; seed += 2) {
    const MovingNoise noise = moving(GetParam(), 16, seed);
    measured += mean_product(noise.samples(0), noise.samples(0));
    expected += noise.variance(0);
  }
  EXPECT_NEAR(measured / expected, 1.0, 0.1);
}

TEST_P(MovingNoiseDims, SameSeedSameBitsAndAnotherFieldIsUnrelated) {
  const MovingNoise noise = moving(GetParam(), 32);
  EXPECT_EQ(copy_of(noise.samples(0)), copy_of(moving(GetParam(), 32).samples(0)));
  EXPECT_NE(copy_of(noise.samples(0)), copy_of(moving(GetParam(), 32, 9).samples(0)));
  double likeness = 0.0;  // of two fields; a few long waves have most of the power, so that one seed says little
  constexpr int kSeeds = 60;
  for (std::uint64_t seed = 0; seed < 2 * kSeeds; seed += 2) {
    const MovingNoise other = moving(GetParam(), 16, seed);
    likeness += mean_product(other.samples(0), other.samples(1)) / other.variance(0) / kSeeds;
  }
  EXPECT_NEAR(likeness, 0.0, 0.25);
}

INSTANTIATE_TEST_SUITE_P(SquareAndCube, MovingNoiseDims, testing::Values(2, 3));

TEST(MovingNoise, RefusesSizesThatNoNoiseHas) {
  const std::vector<MovingField> fields = {{uneven_power, 1}};
  EXPECT_THROW(MovingNoise(2, 100, fields), std::invalid_argument);
  EXPECT_THROW(MovingNoise(1, 64, fields), std::invalid_argument);
  EXPECT_THROW(MovingNoise(2, 64, {}), std::invalid_argument);
}

}  // namespace
}  // namespace yuragi::noise
