#include "engine/wind/turbulence/gust_noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "engine/fft/real_fft.hpp"
#include "engine/noise/von_karman_corner.hpp"
#include "engine/wind/turbulence/gust_variances.hpp"
#include "engine/wind/turbulence/von_karman_integrals.hpp"
#include "engine/wind/turbulence/wind_spectrum.hpp"
#include "tests/support/wind_coherence.hpp"

namespace yuragi::wind::turbulence {
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
    const std::size_t tile = GustNoise::kFirstTileOctave + which * GustNoise::kTileOctaves;
    EXPECT_NEAR(way_ends / octaves[tile].from_rad_m, 1.0, 1e-12);
    const double shortest_m = 2.0 * std::numbers::pi / follow(tile, GustNoise::kTileOctaves);
    EXPECT_NEAR(shortest_m, which == 0 ? 0.25 : 0.25 * std::numbers::phi, 1e-9);
  }
  EXPECT_NEAR(octaves[GustNoise::kFirstTileOctave].from_rad_m, 2.0 * std::numbers::pi / 2048.0, 1e-12);
}

/// Places that fill the plane evenly: multiples of two irrational numbers. Many periods of the longest tile.
struct Spot {
  explicit Spot(int i)
      : east_m(30000.0 * std::fmod(i * 0.7548776662466927, 1.0)),
        south_m(30000.0 * std::fmod(i * 0.5698402909980532, 1.0)) {}
  double east_m, south_m;
};

TEST(GustNoise, EachOctaveHasMeanZeroAndVarianceOneOverTheGround) {
  GustNoise::Values sum{};
  GustNoise::Values squares{};
  constexpr int kPlaces = 20000;
  for (int i = 0; i < kPlaces; ++i) {
    const GustNoise::Values values = gust_noise().at({}, Spot(i).east_m, Spot(i).south_m);
    for (std::size_t o = 0; o < GustNoise::kOctaves; ++o) {
      sum.along[o] += values.along[o];
      squares.along[o] += values.along[o] * values.along[o];
      squares.across[o] += values.across[o] * values.across[o];
    }
  }
  for (std::size_t o = GustNoise::kFirstTileOctave; o < GustNoise::kOctaves; ++o) {
    EXPECT_NEAR(sum.along[o] / kPlaces, 0.0F, 0.04F) << o;
    EXPECT_NEAR(squares.along[o] / kPlaces, 1.0F, 0.05F) << o;
    EXPECT_NEAR(squares.across[o] / kPlaces, 1.0F, 0.05F) << o;
  }
}

TEST(GustNoise, TheWayHasVarianceOneInEachOctave) {
  GustNoise::Carried carried;
  std::array<double, GustNoise::kFirstTileOctave> squares{};
  constexpr int kMoments = 20000;
  for (int i = 0; i < kMoments; ++i) {
    gust_noise().carry(carried, 30.0, 40.0, 17.3);
    const GustNoise::Values values = gust_noise().at(carried, 0.0, 0.0);
    for (std::size_t o = 0; o < squares.size(); ++o) {
      squares[o] += static_cast<double>(values.along[o] * values.along[o]) / kMoments;
    }
  }
  for (std::size_t o = 0; o < squares.size(); ++o) EXPECT_NEAR(squares[o], 1.0, 0.05) << o;
}

/// A wind of 7 m/s whose gusts are von Karman's.
constexpr double kIntensity = 0.2;
constexpr double kLength_m = 57.0;
GustNoise::Moment von_karman_gusts(const GustNoise& noise, float gustiness = 0.0F) {
  GustNoise::Moment moment;
  const GustVariances variances = gust_variances(noise, kIntensity, kLength_m);
  for (std::size_t o = 0; o < GustNoise::kOctaves; ++o) {
    moment.along_m_s[o] = moment.across_m_s[o] = static_cast<float>(7.0 * std::sqrt(variances[o]));
  }
  moment.gustiness = gustiness;
  return moment;
}

/// The gusts along lines through the noise at the same moment, side by side, and their spectra.
class GustLines {
 public:
  static constexpr std::size_t kSamples = 1U << 14U;
  static constexpr double kStep_m = 0.4;

  /// Adds a line through a noise, and those so far to its side. Component 0 is along the line, 1 to the left of it.
  void add(const GustNoise& noise, double angle_rad, std::span<const double> beside_m) {
    GustNoise::Moment gusts = von_karman_gusts(noise);
    gusts.ahead = {std::cos(angle_rad), -std::sin(angle_rad)};
    const Modes first = modes_of(noise, gusts, 0.0);
    coherent.resize(beside_m.size());
    for (std::size_t side = 0; side < beside_m.size(); ++side) {
      const Modes other = modes_of(noise, gusts, beside_m[side]);
      coherent[side].resize(fft_.row_modes());
      for (std::size_t k = 1; k < fft_.row_modes(); ++k) {
        coherent[side][k] += (first[0][k] * std::conj(other[0][k])).real();
      }
    }
    for (std::size_t component = 0; component < 2; ++component) {
      power[component].resize(fft_.row_modes());
      for (std::size_t k = 1; k < fft_.row_modes(); ++k) power[component][k] += std::norm(first[component][k]);
    }
  }

  static std::size_t mode_of(double wave_m) { return static_cast<std::size_t>(kSamples * kStep_m / wave_m); }
  static double sum(const std::vector<double>& values, double longest_m) {
    double sum = 0.0;
    for (std::size_t k = mode_of(longest_m); k < mode_of(0.5 * longest_m); ++k) sum += values[k];
    return sum;
  }

  std::array<std::vector<double>, 2> power;   ///< of both components
  std::vector<std::vector<double>> coherent;  ///< of the first one, between the line and each of the others

 private:
  using Modes = std::array<std::vector<std::complex<double>>, 2>;

  Modes modes_of(const GustNoise& noise, const GustNoise::Moment& gusts, double beside_m) {
    std::array<std::vector<double>, 2> line_m_s;
    for (auto& component : line_m_s) component.resize(kSamples);
    const Vector ahead = gusts.ahead;
    for (std::size_t i = 0; i < kSamples; ++i) {
      const double way_m = kStep_m * static_cast<double>(i);
      const Vector gust = noise.local(gusts, ahead.u_m_s * way_m - ahead.v_m_s * beside_m,
                                      -ahead.v_m_s * way_m - ahead.u_m_s * beside_m);
      const double hann = 1.0 - std::cos(2.0 * std::numbers::pi * (static_cast<double>(i) + 0.5) / kSamples);
      line_m_s[0][i] = hann * (gust.u_m_s * ahead.u_m_s + gust.v_m_s * ahead.v_m_s);
      line_m_s[1][i] = hann * (gust.v_m_s * ahead.u_m_s - gust.u_m_s * ahead.v_m_s);
    }
    Modes modes;
    for (std::size_t component = 0; component < 2; ++component) {
      std::ranges::copy(line_m_s[component], fft_.samples().begin());
      fft_.forward();
      modes[component].assign(fft_.spectrum().begin(), fft_.spectrum().end());
    }
    return modes;
  }

  fft::RealFft fft_{1, kSamples};
};

/// Von Karman's density of a component for a mode of such a line, of variance 1.
double density_of_mode(WindComponent component, std::size_t k) {
  constexpr double kLine_m = GustLines::kSamples * GustLines::kStep_m;
  static const auto kSpectrum = [](WindComponent of) {
    return WindSpectrum::make({.model = SpectrumModel::kVonKarman,
                               .component = of,
                               .speed_m_s = 1.0,
                               .sigma_m_s = 1.0,
                               .length_m = kLength_m})
        .value();
  };
  static const std::array kSpectra = {kSpectrum(WindComponent::kAlong), kSpectrum(WindComponent::kAcross)};
  return kSpectra[component == WindComponent::kAlong ? 0 : 1].density_m2_s2_hz(static_cast<double>(k) / kLine_m) /
         kLine_m;
}

/// Of the longest waves there are few in six noises: of thirty, all coherences are within 0.06.
TEST(GustNoise, IsThePlaneOfIsotropicTurbulenceFromAMetreToAKilometre) {
  constexpr std::array kBeside_m = {1.0, 3.0, 7.0, 20.0};
  constexpr int kSeeds = 6;
  constexpr int kLines = 2;
  GustLines lines;
  for (int line = 0; line < kSeeds * kLines; ++line) {
    const GustNoise noise({.seed = static_cast<std::uint64_t>(1 + line / kLines)});
    lines.add(noise, 0.37 + line * std::numbers::phi, kBeside_m);
  }
  const double scale = 2.0 / 1.5 / (kSeeds * kLines) / GustLines::kSamples / GustLines::kSamples;
  const double corner_m = 2.0 * std::numbers::pi * noise::kVonKarmanCorner * kLength_m;
  std::array<double, 2> inertial{};
  for (int octave = 0; octave < 10; ++octave) {
    const double longest_m = std::ldexp(1000.0, -octave);
    SCOPED_TRACE(testing::Message() << "waves of up to " << longest_m << " m");
    // By theory, mode by mode: the power of u and v, and what u has in common with itself at those distances.
    std::array<double, 2> theory{};
    std::array<double, kBeside_m.size()> coherent{};
    for (std::size_t k = GustLines::mode_of(longest_m); k < GustLines::mode_of(0.5 * longest_m); ++k) {
      const double u = density_of_mode(WindComponent::kAlong, k);
      theory[0] += u;
      theory[1] += density_of_mode(WindComponent::kAcross, k);
      const double k_rad_m =
          2.0 * std::numbers::pi * static_cast<double>(k) / (GustLines::kSamples * GustLines::kStep_m);
      for (std::size_t side = 0; side < kBeside_m.size(); ++side) {
        coherent[side] += u * von_karman_coherence(k_rad_m, kBeside_m[side], kLength_m);
      }
    }
    for (std::size_t component = 0; component < 2; ++component) {
      const double power = scale * GustLines::sum(lines.power[component], longest_m);
      const double tolerance_db = longest_m > 0.5 * corner_m ? 1.5 : component == 0 ? 0.5 : 1.0;
      EXPECT_NEAR(10.0 * std::log10(power / (49.0 * kIntensity * kIntensity * theory[component])), 0.0, tolerance_db)
          << (component == 0 ? "u" : "v");
      if (longest_m < corner_m / 5.0) inertial[component] += power;
    }
    for (std::size_t side = 0; side < kBeside_m.size(); ++side) {
      EXPECT_NEAR(GustLines::sum(lines.coherent[side], longest_m) / GustLines::sum(lines.power[0], longest_m),
                  coherent[side] / theory[0], longest_m > 100.0 ? 0.09 : 0.06)
          << kBeside_m[side] << " m across";
    }
  }
  EXPECT_NEAR(inertial[1] / inertial[0], 4.0 / 3.0, 0.12);
}

TEST(GustNoise, TheWayIsTheSameEverywhereAndTheTilesTravelWithTheWind) {
  GustNoise::Carried carried;
  // A minute of wind toward north-east.
  for (int tick = 0; tick < 3600; ++tick) gust_noise().carry(carried, 3.0, -2.0, 1.0 / 60.0);
  const GustNoise::Values before = gust_noise().at({}, 10.0, 20.0);
  const GustNoise::Values downwind = gust_noise().at(carried, 10.0 + 180.0, 20.0 - 120.0);
  const GustNoise::Values elsewhere = gust_noise().at(carried, -40.0, 7.0);
  for (std::size_t o = 0; o < GustNoise::kOctaves; ++o) {
    if (o < GustNoise::kFirstTileOctave) {
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
    const double x_m = Spot(i).east_m;
    const double z_m = Spot(i).south_m;
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
    std::array<double, GustNoise::kOctaves> squares{};
    constexpr int kPlaces = 2000;
    for (int i = 0; i < kPlaces; ++i) {
      const GustNoise::Values values = evolving_gusts().at(carried, Spot(i).east_m, Spot(i).south_m);
      for (std::size_t o = 0; o < squares.size(); ++o) {
        squares[o] += static_cast<double>(values.along[o] * values.along[o]) / kPlaces;
      }
    }
    for (std::size_t o = GustNoise::kFirstTileOctave; o < GustNoise::kOctaves; ++o) {
      EXPECT_NEAR(squares[o], 1.0, 0.12) << "octave " << o << ", step " << step;
    }
  }
}

TEST(GustNoise, AGustDoesNotComeBackUnchangedWhenItsTileHasWrapped) {
  // Once around the first chain's middle tile, eastward. The second chain's is somewhere else by then.
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
  for (std::size_t i = GustNoise::kLongOctaves; i < GustNoise::kTileOctaves - GustNoise::kShortOctaves; ++i) {
    const std::size_t octave = GustNoise::kFirstTileOctave + i;
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
  // other unlike it, 1.4 apart. Octaves of less than eight waves a tile have too few for their signs to even out.
  for (std::size_t i = 3; i < GustNoise::kTileOctaves; ++i) {
    if (i == GustNoise::kLongOctaves || i == GustNoise::kLongOctaves + 1) continue;
    const std::size_t octave = GustNoise::kFirstTileOctave + i;
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

TEST(GustNoise, IsTheSameEachTimeItIsMade) {
  const GustNoise first({.samples = 128, .seed = 9, .evolves = true});
  const GustNoise second({.samples = 128, .seed = 9, .evolves = true});
  GustNoise::Carried carried = first.begin(4);
  first.carry(carried, 3.0, 4.0, 7.0, kTurnover_m23_s);
  for (int i = 0; i < 50; ++i) {
    const auto [east_m, south_m] = Spot(i);
    EXPECT_EQ(first.at(carried, east_m, south_m).along, second.at(carried, east_m, south_m).along);
    EXPECT_EQ(first.at(carried, east_m, south_m).across, second.at(carried, east_m, south_m).across);
  }
}

TEST(GustNoise, WithoutGustinessAllPlacesHaveTheirGustsUnchanged) {
  const GustNoise::Moment gusts = von_karman_gusts(gust_noise());
  EXPECT_EQ(gust_noise().envelope(gusts, 12.0, 34.0), 1.0F);
  const GustNoise::Values values = gust_noise().at({}, 12.0, 34.0);
  float along = 0.0F;
  for (std::size_t o = GustNoise::kFirstTileOctave; o < GustNoise::kOctaves; ++o) {
    along += gusts.along_m_s[o] * values.along[o];
  }
  EXPECT_NEAR(gust_noise().local(gusts, 12.0, 34.0).v_m_s, static_cast<double>(along), 1e-6);
}

TEST(GustNoise, TheEnvelopeKeepsThePowerAndTravelsWithTheGusts) {
  const GustNoise::Moment gusts = von_karman_gusts(gust_noise(), 0.3F);
  const GustNoise::Moment even = von_karman_gusts(gust_noise());
  GustNoise::Moment later = gusts;
  for (int tick = 0; tick < 600; ++tick) gust_noise().carry(later.carried, 3.0, -2.0, 1.0 / 60.0);
  double squares = 0.0;
  constexpr int kPlaces = 20000;
  for (int i = 0; i < kPlaces; ++i) {
    const auto [east_m, south_m] = Spot(i);
    const float strength = gust_noise().envelope(gusts, east_m, south_m);
    squares += static_cast<double>(strength * strength) / kPlaces;
    if (i % 100 != 0) continue;
    EXPECT_NEAR(gust_noise().envelope(later, east_m + 30.0, south_m - 20.0), strength, 1e-4F);
    EXPECT_NEAR(gust_noise().local(gusts, east_m, south_m).u_m_s,
                static_cast<double>(strength) * gust_noise().local(even, east_m, south_m).u_m_s, 1e-5);
  }
  EXPECT_NEAR(squares, 1.0, 0.03);
}

/// Of the changes of the wind over 1.4 m, as far as a wind of 7 m/s carries it in 0.2 s.
struct Increments {
  double variance = 0.0, kurtosis = 0.0;
};
Increments increments_of(const GustNoise& noise, float gustiness) {
  const GustNoise::Moment gusts = von_karman_gusts(noise, gustiness);
  constexpr int kPlaces = 100000;
  double squares = 0.0;
  double fourths = 0.0;
  for (int i = 0; i < kPlaces; ++i) {
    const auto [east_m, south_m] = Spot(i);
    const double change = noise.local(gusts, east_m + 1.4, south_m).v_m_s - noise.local(gusts, east_m, south_m).v_m_s;
    squares += change * change / kPlaces;
    fourths += std::pow(change, 4.0) / kPlaces;
  }
  return {squares, fourths / squares / squares};
}

TEST(GustNoise, GustsOfUnequalStrengthHaveSharpIncrements) {
  // An increment of normal distribution has a kurtosis of 3; a strength of exp(g G) makes it 3 exp(4 g^2).
  const Increments even = increments_of(gust_noise(), 0.0F);
  const Increments gusty = increments_of(gust_noise(), 0.3F);
  EXPECT_NEAR(even.kurtosis, 3.0, 0.2);
  EXPECT_NEAR(gusty.kurtosis, 3.0 * std::exp(4.0 * 0.09), 0.35);
  EXPECT_NEAR(gusty.variance / even.variance, 1.0, 0.05);
}

/// Of how the wind changes at a place, along the mean wind, while that carries it over a distance.
struct Change {
  double variance = 0.0, skewness = 0.0;
};
Change change_over(const GustNoise& noise, const GustNoise::Moment& gusts, double distance_m) {
  constexpr int kPlaces = 200000;
  const Vector ahead = gusts.ahead;
  double squares = 0.0;
  double cubes = 0.0;
  for (int i = 0; i < kPlaces; ++i) {
    const auto [east_m, south_m] = Spot(i);
    const Vector here = noise.local(gusts, east_m, south_m);
    const Vector later = noise.local(gusts, east_m - distance_m * ahead.u_m_s, south_m + distance_m * ahead.v_m_s);
    const double change = (later.u_m_s - here.u_m_s) * ahead.u_m_s + (later.v_m_s - here.v_m_s) * ahead.v_m_s;
    squares += change * change / kPlaces;
    cubes += std::pow(change, 3.0) / kPlaces;
  }
  return {squares, cubes / std::pow(squares, 1.5)};
}

TEST(GustNoise, RisesFasterThanItFallsByKolmogorovsLaw) {
  const GustNoise evolving({.period_m = 256.0, .samples = 256, .seed = 5, .evolves = true});
  GustNoise::Moment even = von_karman_gusts(evolving, 0.3F);
  for (int tick = 0; tick < 600; ++tick) evolving.carry(even.carried, 0.0, 7.0, 1.0 / 60.0, 0.3);
  for (const double angle_rad : {0.3, 1.3}) {  // of the tiles' axes none points there
    even.ahead = {std::cos(angle_rad), std::sin(angle_rad)};
    GustNoise::Moment gusts = even;
    gusts.fronts = kFronts;
    for (const double distance_m : {0.7, 3.0, 14.0}) {
      const Change without = change_over(evolving, even, distance_m);
      const Change with = change_over(evolving, gusts, distance_m);
      EXPECT_NEAR(without.skewness, 0.0, 0.05) << distance_m << " m";
      EXPECT_NEAR(with.skewness, 0.28, 0.07) << distance_m << " m";
      EXPECT_NEAR(with.variance / without.variance, 1.0, 0.03) << distance_m << " m";
    }
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
}  // namespace yuragi::wind::turbulence
