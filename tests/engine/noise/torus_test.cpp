#include "engine/noise/torus.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "engine/noise/spectral_noise.hpp"

namespace yuragi::noise {
namespace {

constexpr double kPeriod_m = 256.0;
constexpr int kTicksOfADay = 24 * 3600 * 60;

/// The distance between two phases on the torus, in units of the phase.
std::int64_t apart(std::uint32_t a, std::uint32_t b) {
  return std::abs(std::int64_t{static_cast<std::int32_t>(a - b)});
}

/// The phase of a distance that is known to many more digits than a double has.
std::uint32_t exact_phase(long double distance_m) {
  const long double periods = distance_m / static_cast<long double>(kPeriod_m);
  return static_cast<std::uint32_t>(
      static_cast<std::int64_t>(std::llrint((periods - std::floor(periods)) * 4294967296.0L)));
}

Tile2 some_tile() {
  return make_noise_2d({.size = 64, .seed = 3}).value();
}

TEST(TorusPhaseTest, CountsFractionsOfThePeriod) {
  EXPECT_EQ(torus_phase(0.0, kPeriod_m), 0U);
  EXPECT_EQ(torus_phase(64.0, kPeriod_m), 0x40000000U);
  EXPECT_EQ(torus_phase(128.0, kPeriod_m), 0x80000000U);
  EXPECT_EQ(torus_phase(-64.0, kPeriod_m), 0xC0000000U);
}

TEST(TorusPhaseTest, DropsWholePeriodsExactly) {
  for (const double position_m : {0.0, 1.0 / 3.0, 17.125, 255.9}) {
    for (const double periods : {1.0, -1.0, 1000.0, -1048576.0}) {
      // What the position is once whole periods have been added to it, as a double can say it.
      const double far_m = position_m + periods * kPeriod_m;
      EXPECT_EQ(torus_phase(far_m, kPeriod_m), torus_phase(far_m - periods * kPeriod_m, kPeriod_m));
    }
  }
  EXPECT_EQ(torus_phase(1e300, kPeriod_m), 0U);
}

TEST(TorusPhaseTest, OfANegativePositionIsTheNegative) {
  for (const double position_m : {1e-9, 0.07, 1.0, 127.99, 128.0, 200.3, 1e7 + 0.1}) {
    EXPECT_EQ(torus_phase(-position_m, kPeriod_m), 0U - torus_phase(position_m, kPeriod_m)) << position_m;
  }
}

TEST(TorusTravelTest, ADayOfEqualTicksEndsWhereTheirSumIs) {
  const double step_m = 7.3 / 60.0;
  TorusTravel travel;
  for (int i = 0; i < kTicksOfADay; ++i) travel.add(step_m, kPeriod_m);
  EXPECT_LE(apart(travel.phase(), exact_phase(static_cast<long double>(step_m) * kTicksOfADay)), 1);
}

TEST(TorusTravelTest, StepsMuchSmallerThanAPhaseAreNotLost) {
  const double step_m = kPeriod_m / 4294967296.0 / 1000.0;
  TorusTravel travel;
  for (int i = 0; i < 1'000'000; ++i) travel.add(step_m, kPeriod_m);
  EXPECT_LE(apart(travel.phase(), 1000U), 1);
}

TEST(TorusTravelTest, ADayOfChangingWindDoesNotDrift) {
  TorusTravel travel;
  long double sum_m = 0.0L;
  for (int i = 0; i < kTicksOfADay; ++i) {
    const double step_m = (static_cast<double>(i % 1021) / 100.0 - 3.1) / 60.0;
    travel.add(step_m, kPeriod_m);
    sum_m += static_cast<long double>(step_m);
  }
  EXPECT_LE(apart(travel.phase(), exact_phase(sum_m)), 1);
}

TEST(TorusTravelTest, ThereAndBackIsNowhere) {
  TorusTravel travel;
  for (int i = 0; i < 1000; ++i) travel.add(0.1234567, kPeriod_m);
  for (int i = 0; i < 1000; ++i) travel.add(-0.1234567, kPeriod_m);
  EXPECT_LE(apart(travel.phase(), 0U), 1);
}

TEST(ReadNoiseTest, GivesTheSamplesThemselves) {
  const Tile2 tile = some_tile();
  const std::uint32_t cell = 1U << 26U;  // 2^32 / 64
  for (std::uint32_t z = 0; z < 64; ++z) {
    for (std::uint32_t x = 0; x < 64; ++x) EXPECT_EQ(read_noise(tile, {x * cell, z * cell}), tile.at(x, z));
  }
}

TEST(ReadNoiseTest, IsBilinearBetweenThem) {
  const Tile2 tile = some_tile();
  const std::uint32_t cell = 1U << 26U;
  const float middle = (tile.at(5, 9) + tile.at(6, 9) + tile.at(5, 10) + tile.at(6, 10)) / 4.0F;
  EXPECT_NEAR(read_noise(tile, {5 * cell + cell / 2, 9 * cell + cell / 2}), middle, 1e-6F);
  const float quarter = 0.75F * tile.at(5, 9) + 0.25F * tile.at(6, 9);
  EXPECT_NEAR(read_noise(tile, {5 * cell + cell / 4, 9 * cell}), quarter, 1e-6F);
}

TEST(ReadNoiseTest, HasNoSeam) {
  const Tile2 tile = some_tile();
  const Tile1 line = make_noise_1d({.size = 64, .seed = 3}).value();
  const std::uint32_t half_cell = 1U << 25U;
  EXPECT_NEAR(read_noise(tile, {0U - half_cell, 0}), (tile.at(63, 0) + tile.at(0, 0)) / 2.0F, 1e-6F);
  EXPECT_NEAR(read_noise(tile, {0, 0U - half_cell}), (tile.at(0, 63) + tile.at(0, 0)) / 2.0F, 1e-6F);
  EXPECT_NEAR(read_noise(line, 0U - half_cell), (line.values[63] + line.values[0]) / 2.0F, 1e-6F);
}

TEST(ReadNoiseTest, NeverChangesFasterThanItsSteepestCell) {
  const Tile1 line = make_noise_1d({.size = 64, .seed = 5}).value();
  float steepest = 0.0F;
  for (std::size_t i = 0; i < 64; ++i) {
    steepest = std::max(steepest, std::abs(line.values[(i + 1) % 64] - line.values[i]));
  }

  // Once around and over the seam, in steps of a 1000th of a cell.
  const std::uint32_t step = (1U << 26U) / 1000U;
  float before = read_noise(line, 0);
  for (std::uint32_t i = 1; i < 65'000; ++i) {
    const float now = read_noise(line, i * step);
    EXPECT_LE(std::abs(now - before), steepest / 1000.0F + 1e-6F);
    before = now;
  }
}

TEST(IsReadableTest, AsksForAPowerOfTwoWithAllItsValues) {
  EXPECT_TRUE(is_readable(Tile1{std::vector<float>(2)}));
  EXPECT_TRUE(is_readable(Tile2{4, std::vector<float>(16)}));
  EXPECT_FALSE(is_readable(Tile1{}));
  EXPECT_FALSE(is_readable(Tile1{std::vector<float>(1)}));
  EXPECT_FALSE(is_readable(Tile1{std::vector<float>(12)}));
  EXPECT_FALSE(is_readable(Tile1{std::vector<float>(131072)}));
  EXPECT_FALSE(is_readable(Tile2{}));
  EXPECT_FALSE(is_readable(Tile2{4, std::vector<float>(15)}));
  EXPECT_FALSE(is_readable(Tile2{3, std::vector<float>(9)}));
}

}  // namespace
}  // namespace yuragi::noise
