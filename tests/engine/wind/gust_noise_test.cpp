#include "engine/wind/gust_noise.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "engine/wind/wind_spectrum.hpp"

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

constexpr double kTurnover_m23_s = 0.35;

const GustNoise& evolving_gusts() {
  static const GustNoise kNoise({.period_m = 256.0, .samples = 256, .seed = 5, .evolves = true});
  return kNoise;
}

/// Of an octave with itself at two moments, the second read `east_m` further on; over places that fill the ground.
double octave_likeness(const GustNoise& noise, const GustNoise::Carried& before, const GustNoise::Carried& after,
                       std::size_t octave, double east_m = 0.0) {
  double product = 0.0;
  double squares = 0.0;
  for (int i = 0; i < 3000; ++i) {
    const double x_m = 2000.0 * std::fmod(i * 0.7548776662466927, 1.0);
    const double z_m = 2000.0 * std::fmod(i * 0.5698402909980532, 1.0);
    const auto first = static_cast<double>(noise.at(before, x_m, z_m).along[octave]);
    product += first * static_cast<double>(noise.at(after, x_m + east_m, z_m).along[octave]);
    squares += first * first;
  }
  return product / squares;
}

TEST(GustNoise, BeginsTheSameWhetherItEvolvesOrNot) {
  const GustNoise frozen({.period_m = 256.0, .samples = 256, .seed = 5});
  for (int i = 0; i < 50; ++i) {
    EXPECT_EQ(frozen.at({}, 7.1 * i, 3.3 * i).along, evolving_gusts().at({}, 7.1 * i, 3.3 * i).along);
  }
  // And without a turnover it stays the same.
  GustNoise::Carried carried;
  frozen.carry(carried, 3.0, 1.0, 10.0);
  GustNoise::Carried untold;
  evolving_gusts().carry(untold, 3.0, 1.0, 10.0);
  EXPECT_EQ(frozen.at(carried, 5.0, 6.0).across, evolving_gusts().at(untold, 5.0, 6.0).across);
}

TEST(GustNoise, KeepsItsVarianceWhileItsEddiesTurn) {
  GustNoise::Carried carried;
  for (int step = 0; step < 12; ++step) {
    evolving_gusts().carry(carried, 0.0, 0.0, 3.7, kTurnover_m23_s);
    for (std::size_t o = 2 * GustNoise::kWayOctaves; o < GustNoise::kOctaves; ++o) {
      double squares = 0.0;
      constexpr int kPlaces = 2000;
      for (int i = 0; i < kPlaces; ++i) {
        const double x_m = 256.0 * std::fmod(i * 0.7548776662466927, 1.0) + 2560.0 * (i % 7);
        const double z_m = 256.0 * std::fmod(i * 0.5698402909980532, 1.0);
        const auto value = static_cast<double>(evolving_gusts().at(carried, x_m, z_m).along[o]);
        squares += value * value / kPlaces;
      }
      EXPECT_NEAR(squares, 1.0, 0.25) << "octave " << o << ", step " << step;
    }
  }
}

TEST(GustNoise, AGustDoesNotComeBackUnchangedWhenItsTileHasWrapped) {
  // Once around the first tile, eastward. The second tile is somewhere else by then.
  GustNoise::Carried frozen;
  GustNoise::Carried evolving;
  for (int tick = 0; tick < 320; ++tick) {
    evolving_gusts().carry(frozen, 8.0, 0.0, 0.1);
    evolving_gusts().carry(evolving, 8.0, 0.0, 0.1, kTurnover_m23_s);
  }
  // Weighted with the power that a spectrum of 1/f^(5/3) has in them.
  double frozen_power = 0.0;
  double evolving_power = 0.0;
  double power = 0.0;
  for (std::size_t i = 0; i < GustNoise::kTileOctaves; ++i) {
    const std::size_t octave = 2 * GustNoise::kWayOctaves + i;
    const double weight = std::pow(2.0, -2.0 / 3.0 * static_cast<double>(i));
    power += weight;
    frozen_power += weight * octave_likeness(evolving_gusts(), {}, frozen, octave);
    evolving_power += weight * octave_likeness(evolving_gusts(), {}, evolving, octave);
    // Each has turned by its own rate.
    const double middle_rad_m = std::numbers::sqrt2 * evolving_gusts().octaves()[octave].from_rad_m;
    const double angle_rad = 32.0 * kTurnover_m23_s * std::pow(middle_rad_m, 2.0 / 3.0);
    EXPECT_NEAR(octave_likeness(evolving_gusts(), {}, evolving, octave), std::cos(angle_rad), 0.1) << i;
  }
  EXPECT_GT(frozen_power / power, 0.99);
  EXPECT_LT(std::abs(evolving_power / power), 0.4);
}

TEST(GustNoise, EvolvingDoesNotMoveIt) {
  // A quarter turn, then an eighth of a wave to either side: of a wave that had moved with it one would be like it, the
  // other unlike it, 1.4 apart. The longest octaves have too few waves for their signs to even out.
  constexpr std::size_t kFewWaves = 2;
  for (std::size_t i = kFewWaves; i < GustNoise::kTileOctaves; ++i) {
    const std::size_t octave = 2 * GustNoise::kWayOctaves + i;
    const double from_rad_m = evolving_gusts().octaves()[octave].from_rad_m;
    const double rate_rad_s = kTurnover_m23_s * std::pow(std::numbers::sqrt2 * from_rad_m, 2.0 / 3.0);
    GustNoise::Carried turned;
    evolving_gusts().carry(turned, 0.0, 0.0, 0.5 * std::numbers::pi / rate_rad_s, kTurnover_m23_s);
    const double east_m = 0.125 * 2.0 * std::numbers::pi / (std::numbers::sqrt2 * from_rad_m);
    EXPECT_NEAR(octave_likeness(evolving_gusts(), {}, turned, octave, east_m),
                octave_likeness(evolving_gusts(), {}, turned, octave, -east_m), 0.4)
        << i;
  }
}

TEST(GustNoise, EddiesTurnOverAsKolmogorovSays) {
  // The inertial range of von Karman's spectrum is that of the dissipation: 0.5 epsilon^(2/3) k^(-5/3) (one-sided).
  const double turnover = eddy_turnover_m23_s(1.4, 57.0);
  const WindSpectrum spectrum =
      WindSpectrum::make({.model = SpectrumModel::kVonKarman, .speed_m_s = 7.0, .sigma_m_s = 1.4, .length_m = 57.0})
          .value();
  constexpr double kFrequency_hz = 50.0;
  const double k_rad_m = 2.0 * std::numbers::pi * kFrequency_hz / 7.0;
  const double per_wavenumber = spectrum.density_m2_s2_hz(kFrequency_hz) * 7.0 / (2.0 * std::numbers::pi);
  EXPECT_NEAR(per_wavenumber * std::pow(k_rad_m, 5.0 / 3.0), 0.5 * turnover * turnover, 0.02 * turnover * turnover);
}

}  // namespace
}  // namespace yuragi
