#include "engine/wind/gust_noise.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace yuragi {
namespace {

/// One for all: it is large.
const GustNoise& gust_noise() {
  static const GustNoise kNoise({.period_m = 256.0, .samples = 256, .seed = 5});
  return kNoise;
}

TEST(GustNoise, CoversTheWavesFromTheWayToTheTileWithoutAGap) {
  const auto& octaves = gust_noise().octaves();
  const auto follow = [&](std::size_t first, std::size_t count) {
    for (std::size_t i = first; i + 1 < first + count; ++i) {
      EXPECT_DOUBLE_EQ(octaves[i].to_rad_m, octaves[i + 1].from_rad_m);
      EXPECT_DOUBLE_EQ(octaves[i].to_rad_m, 2.0 * octaves[i].from_rad_m);
    }
    return octaves[first + count - 1].to_rad_m;
  };
  for (std::size_t which = 0; which < 2; ++which) {
    const double way_ends = follow(which * GustNoise::kWayOctaves, GustNoise::kWayOctaves);
    const std::size_t tile = 2 * GustNoise::kWayOctaves + which * GustNoise::kTileOctaves;
    EXPECT_NEAR(way_ends / octaves[tile].from_rad_m, 1.0, 1e-12);
    follow(tile, GustNoise::kTileOctaves);
  }
  EXPECT_NEAR(octaves[2 * GustNoise::kWayOctaves].from_rad_m, 2.0 * std::numbers::pi / 256.0, 1e-12);
}

TEST(GustNoise, EachOctaveHasMeanZeroAndVarianceOneOverTheGround) {
  GustNoise::Values sum{};
  GustNoise::Values squares{};
  constexpr int kPlaces = 20000;
  for (int i = 0; i < kPlaces; ++i) {
    // Places that fill the plane evenly: multiples of two irrational numbers.
    const double east_m = 256.0 * std::fmod(i * 0.7548776662466927, 1.0) + 3000.0 * (i % 7);
    const double south_m = 256.0 * std::fmod(i * 0.5698402909980532, 1.0) - 2000.0 * (i % 5);
    const GustNoise::Values values = gust_noise().at({}, east_m, south_m);
    for (std::size_t o = 0; o < GustNoise::kOctaves; ++o) {
      sum.along[o] += values.along[o];
      squares.along[o] += values.along[o] * values.along[o];
      squares.across[o] += values.across[o] * values.across[o];
    }
  }
  for (std::size_t o = 2 * GustNoise::kWayOctaves; o < GustNoise::kOctaves; ++o) {
    EXPECT_NEAR(sum.along[o] / kPlaces, 0.0F, 0.15F) << o;
    EXPECT_NEAR(squares.along[o] / kPlaces, 1.0F, 0.15F) << o;
    EXPECT_NEAR(squares.across[o] / kPlaces, 1.0F, 0.15F) << o;
  }
}

TEST(GustNoise, TheWayIsTheSameEverywhereAndTheTilesTravelWithTheWind) {
  GustNoise::Carried carried;
  // A minute of wind toward north-east.
  for (int tick = 0; tick < 3600; ++tick) gust_noise().carry(carried, 3.0, -2.0, 1.0 / 60.0);
  const GustNoise::Values before = gust_noise().at({}, 10.0, 20.0);
  const GustNoise::Values downwind = gust_noise().at(carried, 10.0 + 180.0, 20.0 - 120.0);
  const GustNoise::Values elsewhere = gust_noise().at(carried, -40.0, 7.0);
  for (std::size_t o = 0; o < GustNoise::kOctaves; ++o) {
    if (o < 2 * GustNoise::kWayOctaves) {
      EXPECT_EQ(downwind.along[o], elsewhere.along[o]) << o;
    } else {
      EXPECT_NEAR(before.along[o], downwind.along[o], 1e-3F) << "what was here is there now: " << o;
      EXPECT_NEAR(before.across[o], downwind.across[o], 1e-3F) << o;
    }
  }
}

TEST(GustNoise, ComponentsAndSeedsAreUnrelated) {
  const GustNoise other({.period_m = 256.0, .samples = 256, .seed = 6});
  double components = 0.0;
  double seeds = 0.0;
  constexpr int kPlaces = 4000;
  constexpr std::size_t kOctave = GustNoise::kOctaves - 1;
  for (int i = 0; i < kPlaces; ++i) {
    const double east_m = 1.7 * i;
    const double south_m = 2.3 * (i % 97);
    const GustNoise::Values mine = gust_noise().at({}, east_m, south_m);
    components += static_cast<double>(mine.along[kOctave] * mine.across[kOctave]) / kPlaces;
    seeds += static_cast<double>(mine.along[kOctave] * other.at({}, east_m, south_m).along[kOctave]) / kPlaces;
  }
  EXPECT_NEAR(components, 0.0, 0.1);
  EXPECT_NEAR(seeds, 0.0, 0.1);
}

}  // namespace
}  // namespace yuragi
