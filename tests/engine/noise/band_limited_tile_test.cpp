#include "engine/noise/band_limited_tile.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "engine/noise/spectral_noise.hpp"
#include "tests/engine/noise/periodogram.hpp"

namespace yuragi::noise {
namespace {

constexpr std::size_t kTileSize = 128;
constexpr double kTilePeriod_m = 64.0;

Tile2 plain_tile() {
  return make_noise_2d({.size = kTileSize, .beta = 1.0, .meaning = BetaMeaning::kRadial, .seed = 6}).value();
}

/// |k| in cycles an edge of the i-th mode of the half spectrum.
double cycles_of(std::size_t i) {
  const std::size_t z = i / (kTileSize / 2 + 1);
  return std::hypot(static_cast<double>(i % (kTileSize / 2 + 1)), static_cast<double>(std::min(z, kTileSize - z)));
}

TEST(BandLimitedTileTest, TheBaseLevelIsThePlainTileBitForBit) {
  const Tile2 plain = plain_tile();
  const BandLimitedTile2 tile(plain);
  EXPECT_EQ(tile.level(0).values, plain.values);
  EXPECT_EQ(tile.level_count(), 4U);
}

TEST(BandLimitedTileTest, EachLevelKeepsTheLongWavesAndHasNoShortOnes) {
  const BandLimitedTile2 tile(plain_tile(), 5);
  const std::vector<double> base = test::square_power(tile.level(0));
  for (std::size_t level = 1; level < tile.level_count(); ++level) {
    const std::vector<double> power = test::square_power(tile.level(level));
    EXPECT_DOUBLE_EQ(tile.end_cycles(level), 0.5 * tile.end_cycles(level - 1));
    for (std::size_t i = 1; i < power.size(); ++i) {
      const double k = cycles_of(i);
      if (k >= tile.end_cycles(level)) {
        ASSERT_LT(power[i], 1e-6) << k;  // rounding to 2^-20; a mode of the base has 16384
      } else if (k <= 0.5 * tile.end_cycles(level)) {
        ASSERT_NEAR(std::sqrt(power[i] / base[i]), 1.0, 1e-2) << k;
      } else {
        ASSERT_LE(power[i], base[i] * 1.01 + 1e-6) << k;
      }
    }
  }
}

TEST(BandLimitedTileTest, NothingThatIsPickedIsFasterThanTheTicksCanShow) {
  const BandLimitedTile2 tile(plain_tile(), 6);
  for (const double rate_hz : {25.0, 60.0, 120.0}) {
    for (int tenths = 0; tenths < 600; ++tenths) {
      const double speed_m_s = 0.1 * tenths;
      const BandPick pick = tile.pick(speed_m_s, rate_hz, kTilePeriod_m);
      ASSERT_GE(pick.weight, 0.0F);
      ASSERT_LT(pick.weight, 1.0F);
      ASSERT_EQ(pick.next, std::min(pick.level + 1, tile.level_count() - 1));
      if (pick.level + 1 == tile.level_count()) continue;  // beyond what it can do
      const double finest_rad_m = 2.0 * std::numbers::pi * tile.end_cycles(pick.level) / kTilePeriod_m;
      ASSERT_LE(finest_rad_m * speed_m_s, std::numbers::pi * rate_hz) << speed_m_s;
    }
  }
}

TEST(BandLimitedTileTest, SixLevelsReachAsFarAsTheStrongestWind) {
  const BandLimitedTile2 tile(plain_tile(), 6);
  EXPECT_LT(tile.pick(60.0, 60.0, kTilePeriod_m).level, 5U);
}

TEST(BandLimitedTileTest, TheChoiceIsContinuousInTheSpeed) {
  const BandLimitedTile2 tile(plain_tile(), 5);
  const auto place = [&tile](double speed_m_s) {
    const BandPick pick = tile.pick(speed_m_s, 60.0, kTilePeriod_m);
    return static_cast<double>(pick.level) + static_cast<double>(pick.weight);
  };
  EXPECT_EQ(place(0.0), 0.0);
  EXPECT_EQ(place(1.0), 0.0);
  EXPECT_EQ(place(1e6), 4.0);
  for (int k = 0; k < 5700; ++k) {  // to 300 m/s
    const double speed_m_s = std::pow(1.001, k);
    const double step = place(speed_m_s * 1.001) - place(speed_m_s);
    ASSERT_GE(step, 0.0);
    ASSERT_LT(step, 0.002);  // log2(1.001) = 0.00144
  }
}

TEST(BandLimitedTileTest, InAStormNoPlaceJittersFromTickToTick) {
  // The path of a value over three ticks: a wave at Nyquist turns at every tick. White noise, carried at 40 m/s: read
  // plainly, the values of neighbouring ticks are little alike; picked, they are very much so.
  const BandLimitedTile2 tile(plain_tile(), 6);
  const auto likeness = [&tile](BandPick pick) {
    double both = 0.0;
    double all = 0.0;
    for (std::uint32_t line = 0; line < 64; ++line) {
      TorusTravel way;
      float before = 0.0F;
      for (int tick = 0; tick < 200; ++tick) {
        const float now = read_noise(tile, pick, TorusPhase{way.phase(), line << 26U});
        both += static_cast<double>(now) * static_cast<double>(before);
        all += static_cast<double>(now) * static_cast<double>(now);
        before = now;
        way.add(40.0 / 60.0, kTilePeriod_m);
      }
    }
    return both / all;
  };
  EXPECT_LT(likeness({}), 0.4);
  EXPECT_GT(likeness(tile.pick(40.0, 60.0, kTilePeriod_m)), 0.9);
}

TEST(BandLimitedTileTest, RefusesWhatIsNoTileAndTooManyLevels) {
  EXPECT_THROW(BandLimitedTile2(Tile2{3, std::vector<float>(9)}), std::invalid_argument);
  EXPECT_THROW(BandLimitedTile2(plain_tile(), 0), std::invalid_argument);
  EXPECT_THROW(BandLimitedTile2(plain_tile(), 9), std::invalid_argument);
}

}  // namespace
}  // namespace yuragi::noise
