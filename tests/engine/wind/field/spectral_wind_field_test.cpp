#include "engine/wind/field/spectral_wind_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "engine/fft/real_fft.hpp"
#include "engine/wind/field/von_karman_modes.hpp"
#include "tests/support/wind_coherence.hpp"

namespace yuragi::wind::field {
namespace {

/// A tile of 16 lengths, its samples 32 to a length; lines along x are lines along the wind.
constexpr WindFieldSettings kFine{.speed_m_s = 10.0,
                                  .direction_deg = 270.0,
                                  .turbulence_intensity = 0.2,
                                  .length_m = 16.0,
                                  .samples = 512,
                                  .spacing_m = 0.5,
                                  .evolves = false};
constexpr double kSigma_m_s = 2.0;
constexpr double kPeriod_m = 256.0;
constexpr std::size_t kRows = 128;
constexpr int kFineSeeds = 10;

using Line = std::vector<std::complex<double>>;
/// The Fourier modes of a component along lines, by seed and row. A mode's mean square is the variance of its wave.
using Lines = std::vector<std::vector<Line>>;

std::array<Lines, 2> measure_lines() {
  std::array<Lines, 2> all;
  fft::RealFft fft(1, kFine.samples);
  const Grid grid{.count_x = kFine.samples, .count_y = 1, .count_z = kRows, .spacing_m = kFine.spacing_m};
  std::vector<float> values(2 * grid.size());
  for (int seed = 0; seed < kFineSeeds; ++seed) {
    WindFieldSettings settings = kFine;
    settings.seed = static_cast<std::uint64_t>(seed);
    sample_field(SpectralWindField(settings), grid, values);
    for (std::size_t component = 0; component < 2; ++component) {
      std::vector<Line> rows;
      for (std::size_t row = 0; row < kRows; ++row) {
        std::ranges::copy(std::span(values).subspan(component * grid.size() + row * grid.count_x, grid.count_x),
                          fft.samples().begin());
        fft.forward();
        Line line;
        for (const std::complex<double> mode : fft.spectrum()) {
          line.push_back(mode / static_cast<double>(grid.count_x));
        }
        line[0] -= component == 0 ? kFine.speed_m_s : 0.0;
        rows.push_back(std::move(line));
      }
      all[component].push_back(std::move(rows));
    }
  }
  return all;
}

const std::array<Lines, 2>& measured_lines() {
  static const auto kLines = measure_lines();
  return kLines;
}
const Lines& lines_of_u() {
  return measured_lines()[0];
}
const Lines& lines_of_v() {
  return measured_lines()[1];
}

/// The variance of the waves of so many cycles a tile, `from` to one before `to`, on average.
double variance_between(const Lines& lines, std::size_t from, std::size_t to) {
  double sum = 0.0;
  for (const std::vector<Line>& rows : lines) {
    for (const Line& line : rows) {
      for (std::size_t m = from; m < to; ++m) sum += (m == 0 ? 1.0 : 2.0) * std::norm(line[m]);
    }
  }
  return sum / static_cast<double>(lines.size() * kRows);
}

double expected_between(turbulence::WindComponent component, double sigma_m_s, double length_of_u_m, std::size_t from,
                        std::size_t to) {
  const turbulence::WindSpectrum spectrum =
      turbulence::WindSpectrum::make(
          {.component = component, .speed_m_s = kFine.speed_m_s, .sigma_m_s = sigma_m_s, .length_m = length_of_u_m})
          .value();
  const double step_hz = kFine.speed_m_s / kPeriod_m;
  double sum = 0.0;
  for (std::size_t m = from; m < to; ++m) sum += spectrum.density_m2_s2_hz(static_cast<double>(m) * step_hz) * step_hz;
  return sum;
}

TEST(SpectralWindField, APointHasVonKarmansSpectrumOctaveByOctave) {
  // Carried past a point, a line along the wind is what the point sees: m cycles a tile are m U / P hertz.
  for (std::size_t from = 2; from < 64; from *= 2) {
    const double u = variance_between(lines_of_u(), from, 2 * from);
    const double v = variance_between(lines_of_v(), from, 2 * from);
    const double bound_db = from < 8 ? 1.5 : 0.5;  // the longest octaves are few waves, and scatter
    EXPECT_NEAR(
        10.0 * std::log10(u / expected_between(turbulence::WindComponent::kAlong, kSigma_m_s, 16.0, from, 2 * from)),
        0.0, bound_db)
        << "u, from " << from;
    // Across the wind: 0.8 of the deviation, a third of the length, which is half of that of u in such turbulence.
    EXPECT_NEAR(10.0 * std::log10(v / expected_between(turbulence::WindComponent::kAcross, 0.8 * kSigma_m_s,
                                                       2.0 * 16.0 / 3.0, from, 2 * from)),
                0.0, bound_db)
        << "v, from " << from;
  }
}

TEST(SpectralWindField, TheFinestOctavesLackWhatTheTileCannotHold) {
  // A quarter of the finest wave and finer: oblique waves that are too short for the tile are missing there.
  const double u = variance_between(lines_of_u(), 64, 128);
  const double expected = expected_between(turbulence::WindComponent::kAlong, kSigma_m_s, 16.0, 64, 128);
  EXPECT_NEAR(10.0 * std::log10(u / expected), -0.5, 0.5);
}

TEST(SpectralWindField, HasTheVarianceThatWasAskedFor) {
  // Of shorter gusts, those across the wind, more is lost between samples, and said to be.
  const SpectralWindField field(kFine);
  EXPECT_NEAR(field.variance_m2_s2(turbulence::WindComponent::kAlong) / (kSigma_m_s * kSigma_m_s), 1.0, 0.05);
  EXPECT_NEAR(field.variance_m2_s2(turbulence::WindComponent::kAcross) / (0.64 * kSigma_m_s * kSigma_m_s), 1.0, 0.08);
  EXPECT_EQ(field.variance_m2_s2(turbulence::WindComponent::kUpward), 0.0);
  EXPECT_NEAR(variance_between(lines_of_u(), 0, 256) / field.variance_m2_s2(turbulence::WindComponent::kAlong), 1.0,
              0.12);
  EXPECT_NEAR(variance_between(lines_of_v(), 0, 256) / field.variance_m2_s2(turbulence::WindComponent::kAcross), 1.0,
              0.12);
}

/// Long tiles of coarse samples, for what takes many seeds: the mean squares of a place, and of the mean over a line
/// along the wind.
constexpr double kLong_m = 512.0;
struct LongLines {
  double place_m2_s2 = 0.0;
  double mean_m2_s2 = 0.0;
  double expected_m2_s2 = 0.0;  ///< of a place, by the field's own word
};
LongLines measure_long_lines() {
  WindFieldSettings settings = kFine;
  settings.samples = 64;
  settings.spacing_m = kLong_m / 64.0;
  constexpr int kSeeds = 120;
  const Grid grid{.count_x = 64, .count_y = 1, .count_z = 64, .spacing_m = settings.spacing_m};
  std::vector<float> values(2 * grid.size());
  LongLines lines;
  for (int seed = 0; seed < kSeeds; ++seed) {
    settings.seed = static_cast<std::uint64_t>(seed);
    const SpectralWindField field(settings);
    lines.expected_m2_s2 = field.variance_m2_s2(turbulence::WindComponent::kAlong);
    sample_field(field, grid, values);
    for (std::size_t row = 0; row < 64; ++row) {
      double mean = 0.0;
      for (std::size_t i = 0; i < 64; ++i) {
        const double gust = static_cast<double>(values[row * 64 + i]) - settings.speed_m_s;
        mean += gust / 64.0;
        lines.place_m2_s2 += gust * gust / (64.0 * 64.0 * kSeeds);
      }
      lines.mean_m2_s2 += mean * mean / (64.0 * kSeeds);
    }
  }
  return lines;
}

TEST(SpectralWindField, GustsAreAsStrongAsItSaysAndReachAsFarAsTheLengthScale) {
  const LongLines lines = measure_long_lines();
  EXPECT_NEAR(lines.place_m2_s2 / lines.expected_m2_s2, 1.0, 0.05);
  // The mean over a line has the variance 2 sigma^2 L / length.
  const double length_m = lines.mean_m2_s2 * kLong_m / (2.0 * kSigma_m_s * kSigma_m_s);
  EXPECT_NEAR(length_m / kFine.length_m, 1.0, 0.1);
}

/// Of waves about `reduced` = f d / U at rows that are `apart` samples from each other.
double measured_coherence(std::size_t apart, double reduced) {
  const double cycles = reduced * kPeriod_m / (static_cast<double>(apart) * kFine.spacing_m);
  const auto from = static_cast<std::size_t>(std::max(1.0, std::round(0.8 * cycles)));
  const auto to = static_cast<std::size_t>(std::round(1.25 * cycles)) + 1;
  double together = 0.0;
  double power = 0.0;
  for (const std::vector<Line>& rows : lines_of_u()) {
    for (std::size_t row = 0; row + apart < kRows; ++row) {
      for (std::size_t m = from; m < to; ++m) {
        together += (rows[row][m] * std::conj(rows[row + apart][m])).real();
        power += 0.5 * (std::norm(rows[row][m]) + std::norm(rows[row + apart][m]));
      }
    }
  }
  return together / power;
}

TEST(SpectralWindField, CoherenceAcrossTheWindFallsAsDavenports) {
  for (const std::size_t apart : {4U, 8U, 16U}) {
    const double distance_m = static_cast<double>(apart) * kFine.spacing_m;
    double before = 1.0;
    for (const double reduced : {0.05, 0.1, 0.2, 0.4}) {
      const double coherence = measured_coherence(apart, reduced);
      EXPECT_LT(coherence, before + 0.02) << "falls with frequency";
      before = coherence;
      // Of the turbulence it is made of, and of Davenport's formula with the usual decays.
      const double along_rad_m = 2.0 * std::numbers::pi * reduced / distance_m;
      EXPECT_NEAR(coherence, von_karman_coherence(along_rad_m, distance_m, kFine.length_m), 0.08)
          << apart << ", " << reduced;
      EXPECT_NEAR(coherence, davenport_coherence(reduced, distance_m, distance_m, 7.0), 0.15)
          << apart << ", " << reduced;
    }
  }
  // At one frequency (12 cycles a tile, 0.47 Hz) it falls with the distance.
  double before = 1.0;
  for (const std::size_t apart : {2U, 4U, 8U, 16U, 32U}) {
    const double coherence = measured_coherence(apart, 12.0 / kPeriod_m * 0.5 * static_cast<double>(apart));
    EXPECT_LT(coherence, before - 0.02);
    before = coherence;
  }
}

TEST(SpectralWindField, NeighboursDisagreeAsTheyDoInNature) {
  // The difference between two places has 2 sigma^2 (1 - rho): little between near ones, nearly all between far ones.
  const auto difference = [](std::size_t apart) {
    double sum = 0.0;
    for (const std::vector<Line>& rows : lines_of_u()) {
      for (std::size_t row = 0; row + apart < kRows; ++row) {
        for (std::size_t m = 0; m < 256; ++m) {
          sum += (m == 0 ? 1.0 : 2.0) * std::norm(rows[row][m] - rows[row + apart][m]);
        }
      }
    }
    return sum / static_cast<double>(kFineSeeds * (kRows - apart)) / (2.0 * kSigma_m_s * kSigma_m_s);
  };
  EXPECT_LT(difference(1), 0.15);
  EXPECT_GT(difference(1), 0.01);
  EXPECT_GT(difference(96), 0.8);
  EXPECT_LT(difference(4), difference(16));
}

/// A wind from the south-west.
constexpr WindFieldSettings kTurned{.speed_m_s = 10.0,
                                    .direction_deg = 225.0,
                                    .turbulence_intensity = 0.2,
                                    .length_m = 15.0,
                                    .samples = 128,
                                    .spacing_m = 1.0,
                                    .evolves = true};

/// Gusts along the wind at two places on one line with it, each quarter of a second.
struct TwoPlaces {
  std::vector<double> upwind, downwind;

  /// Of the one with the other so many quarters of a second later.
  double correlation(int lag) const {
    double product = 0.0;
    double upwind_squares = 0.0;
    double downwind_squares = 0.0;
    const int count = static_cast<int>(upwind.size());
    for (int i = std::max(0, -lag); i < count - std::max(0, lag); ++i) {
      const double before = upwind[static_cast<std::size_t>(i)];
      const double after = downwind[static_cast<std::size_t>(i + lag)];
      product += before * after;
      upwind_squares += before * before;
      downwind_squares += after * after;
    }
    return product / std::sqrt(upwind_squares * downwind_squares);
  }
};

TwoPlaces watch(const WindFieldSettings& settings, double way_m) {
  SpectralWindField field(settings);
  const double part = std::numbers::sqrt2 / 2.0;
  TwoPlaces places;
  for (int step = 0; step < 160; ++step) {
    field.go_to(0.25 * step);
    const auto gust_at = [&](double along_m) {
      const WindVector3 wind = field.at({part * along_m, 0.0, -part * along_m});  // north-east: x on, z back
      return part * (wind.u_m_s + wind.v_m_s) - settings.speed_m_s;
    };
    places.upwind.push_back(gust_at(0.0));
    places.downwind.push_back(gust_at(way_m));
  }
  return places;
}

TEST(SpectralWindField, GustsArriveDownwindAfterTheirWay) {
  WindFieldSettings settings = kTurned;
  for (const bool evolves : {false, true}) {
    settings.evolves = evolves;
    const TwoPlaces places = watch(settings, 10.0);
    constexpr int kLag = 4;  // 10 m at 10 m/s
    EXPECT_GT(places.correlation(kLag), evolves ? 0.75 : 0.95);
    for (int lag = -16; lag <= 16; ++lag) {
      if (lag == kLag) continue;
      EXPECT_LT(places.correlation(lag), places.correlation(kLag)) << lag;
    }
  }
}

double likeness_of(const std::vector<float>& a, const std::vector<float>& b) {
  double product = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < a.size() / 2; ++i) {
    product += (static_cast<double>(a[i]) - 10.0) * (static_cast<double>(b[i]) - 10.0);
    squares += (static_cast<double>(a[i]) - 10.0) * (static_cast<double>(a[i]) - 10.0);
  }
  return product / squares;
}

TEST(SpectralWindField, AFrozenTileComesRoundAndAnEvolvingOneIsAnother) {
  WindFieldSettings settings = kTurned;
  settings.direction_deg = 270.0;
  settings.length_m = 6.0;
  const Grid grid{.count_x = 128, .count_y = 1, .count_z = 128, .spacing_m = 1.0};
  for (const bool evolves : {false, true}) {
    settings.evolves = evolves;
    SpectralWindField field(settings);
    std::vector<float> before(2 * grid.size());
    std::vector<float> after(2 * grid.size());
    sample_field(field, grid, before);
    field.go_to(12.8);  // 128 m at 10 m/s
    sample_field(field, grid, after);
    const double likeness = likeness_of(before, after);
    if (evolves) {
      EXPECT_LT(std::abs(likeness), 0.4);
      EXPECT_NEAR(likeness_of(after, after), 1.0, 1e-12);
    } else {
      EXPECT_GT(likeness, 0.9);  // what is longer than the tile has changed
    }
    // Back in time is back in the field, bit for bit.
    field.go_to(0.0);
    sample_field(field, grid, after);
    EXPECT_EQ(before, after);
  }
}

TEST(SpectralWindField, InSpaceHasAllThreeComponents) {
  WindFieldSettings settings = kTurned;
  settings.dims = 3;
  settings.direction_deg = 270.0;
  settings.samples = 32;
  const Grid grid{.count_x = 32, .count_y = 32, .count_z = 32, .spacing_m = 1.0};
  double u = 0.0;
  double v = 0.0;
  double w = 0.0;
  constexpr int kSeeds = 10;
  std::vector<float> values(3 * grid.size());
  for (int seed = 0; seed < kSeeds; ++seed) {
    settings.seed = static_cast<std::uint64_t>(seed);
    const SpectralWindField field(settings);
    sample_field(field, grid, values);
    const double count = static_cast<double>(grid.size()) * kSeeds;
    for (std::size_t i = 0; i < grid.size(); ++i) {
      u += std::pow(static_cast<double>(values[i]) - settings.speed_m_s, 2.0) / count;
      v += std::pow(static_cast<double>(values[grid.size() + i]), 2.0) / count;
      w += std::pow(static_cast<double>(values[2 * grid.size() + i]), 2.0) / count;
    }
    if (seed > 0) continue;
    EXPECT_GT(field.variance_m2_s2(turbulence::WindComponent::kUpward), 0.0);
    std::vector<float> again(values.size());
    sample_field(SpectralWindField(settings), grid, again);
    EXPECT_EQ(values, again) << "same seed, same bits";
  }
  // A tile of three lengths holds few long gusts: ten seeds scatter.
  const SpectralWindField field(settings);
  EXPECT_NEAR(u / field.variance_m2_s2(turbulence::WindComponent::kAlong), 1.0, 0.35);
  EXPECT_NEAR(v / field.variance_m2_s2(turbulence::WindComponent::kAcross), 1.0, 0.2);
  EXPECT_NEAR(w / field.variance_m2_s2(turbulence::WindComponent::kUpward), 1.0, 0.1);
  EXPECT_LT(field.variance_m2_s2(turbulence::WindComponent::kUpward), 0.25 * kSigma_m_s * kSigma_m_s);
}

/// Of fields in space over seeds: variances and the covariance of u and w, over what they are said to be, and how much
/// w changes from a sample to the next along the wind.
struct StressRun {
  double u = 0.0, w = 0.0;
  double stress = 0.0;   ///< cov(u, w) over the standard deviations that the field says
  double w_steps = 0.0;  ///< mean square, over the variance of w
};
StressRun measure_stress(double stress, bool evolves) {
  WindFieldSettings settings = kTurned;
  settings.dims = 3;
  settings.direction_deg = 270.0;
  settings.length_m = 8.0;
  settings.samples = 32;
  settings.spacing_m = 2.0;  // eight lengths
  settings.stress = stress;
  settings.evolves = evolves;
  const Grid grid{.count_x = 32, .count_y = 32, .count_z = 32, .spacing_m = settings.spacing_m};
  std::vector<float> values(3 * grid.size());
  constexpr int kSeeds = 24;
  StressRun run;
  for (int seed = 0; seed < kSeeds; ++seed) {
    settings.seed = static_cast<std::uint64_t>(seed);
    SpectralWindField field(settings);
    if (evolves) field.go_to(100.0);
    sample_field(field, grid, values);
    const double u_m2_s2 = field.variance_m2_s2(turbulence::WindComponent::kAlong);
    const double w_m2_s2 = field.variance_m2_s2(turbulence::WindComponent::kUpward);
    EXPECT_NEAR(field.along_up_covariance_m2_s2(), stress * std::sqrt(u_m2_s2 * w_m2_s2), 1e-12);
    const double count = static_cast<double>(grid.size()) * kSeeds;
    for (std::size_t i = 0; i < grid.size(); ++i) {
      const double u = static_cast<double>(values[i]) - settings.speed_m_s;
      const double w = static_cast<double>(values[2 * grid.size() + i]);
      run.u += u * u / count / u_m2_s2;
      run.w += w * w / count / w_m2_s2;
      run.stress += u * w / count / std::sqrt(u_m2_s2 * w_m2_s2);
      if (i % 32 == 31) continue;
      const double step = static_cast<double>(values[2 * grid.size() + i + 1]) - w;
      run.w_steps += step * step / count / w_m2_s2;
    }
  }
  return run;
}

TEST(SpectralWindField, GustsComeDownAndLullsRiseAsMuchAsTheStressSays) {
  const StressRun none = measure_stress(0.0, false);
  EXPECT_NEAR(none.stress, 0.0, 0.03);
  for (const double stress : {-0.3, 0.6}) {
    for (const bool evolves : {false, true}) {
      const StressRun run = measure_stress(stress, evolves);
      EXPECT_NEAR(run.stress, stress, 0.04) << stress;
      EXPECT_NEAR(run.u, 1.0, 0.1);
      EXPECT_NEAR(run.w, 1.0, 0.04);
      EXPECT_NEAR(run.w_steps / none.w_steps, 1.0, 0.02) << "the spectrum of w is what it was";
    }
  }
}

TEST(SpectralWindField, StressChangesTheWindUpwardAlone) {
  WindFieldSettings settings = kTurned;
  settings.dims = 3;
  settings.samples = 16;
  const Grid grid{.count_x = 16, .count_y = 16, .count_z = 16, .spacing_m = 1.0};
  std::vector<float> without(3 * grid.size());
  std::vector<float> with(3 * grid.size());
  sample_field(SpectralWindField(settings), grid, without);
  const std::array variances = {SpectralWindField(settings).variance_m2_s2(turbulence::WindComponent::kAlong),
                                SpectralWindField(settings).variance_m2_s2(turbulence::WindComponent::kUpward)};
  settings.stress = -0.3;
  const SpectralWindField field(settings);
  sample_field(field, grid, with);
  const auto level = static_cast<std::ptrdiff_t>(2 * grid.size());
  EXPECT_TRUE(std::equal(with.begin(), with.begin() + level, without.begin())) << "bit for bit";
  EXPECT_FALSE(std::equal(with.begin() + level, with.end(), without.begin() + level));
  EXPECT_EQ(field.variance_m2_s2(turbulence::WindComponent::kAlong), variances[0]);
  EXPECT_EQ(field.variance_m2_s2(turbulence::WindComponent::kUpward), variances[1]);
}

TEST(SpectralWindField, OnTheGroundIsTheSameAtEveryHeight) {
  const SpectralWindField field(kTurned);
  const WindVector3 low = field.at({3.0, 0.0, 5.0});
  const WindVector3 high = field.at({3.0, 40.0, 5.0});
  EXPECT_EQ(low.u_m_s, high.u_m_s);
  EXPECT_EQ(low.w_m_s, 0.0);
}

TEST(SpectralWindField, CalmIsCalmAndSteadyIsSteady) {
  WindFieldSettings settings = kTurned;
  settings.speed_m_s = 0.0;
  SpectralWindField calm(settings);
  calm.go_to(1e6);
  EXPECT_EQ(calm.at({1.0, 2.0, 3.0}).u_m_s, 0.0);
  settings.speed_m_s = 5.0;
  settings.turbulence_intensity = 0.0;
  settings.direction_deg = 180.0;
  SpectralWindField steady(settings);
  steady.go_to(1e6);
  EXPECT_NEAR(steady.at({1.0, 2.0, 3.0}).v_m_s, 5.0, 1e-12);
}

TEST(SpectralWindField, RefusesWhatIsNoWind) {
  const auto refuses = [](auto change) {
    WindFieldSettings settings = kTurned;
    change(settings);
    EXPECT_THROW(SpectralWindField{settings}, std::invalid_argument);
  };
  refuses([](WindFieldSettings& s) { s.dims = 4; });
  refuses([](WindFieldSettings& s) { s.speed_m_s = -1.0; });
  refuses([](WindFieldSettings& s) { s.stress = -0.3; });  // in two dimensions
  refuses([](WindFieldSettings& s) { s.dims = 3, s.samples = 16, s.stress = 0.61; });
  refuses([](WindFieldSettings& s) { s.dims = 3, s.samples = 16, s.stress = std::nan(""); });
  refuses([](WindFieldSettings& s) { s.direction_deg = std::nan(""); });
  refuses([](WindFieldSettings& s) { s.turbulence_intensity = std::numeric_limits<double>::infinity(); });
  refuses([](WindFieldSettings& s) { s.length_m = 0.0; });
  refuses([](WindFieldSettings& s) { s.spacing_m = 0.0; });
  refuses([](WindFieldSettings& s) { s.samples = 100; });
}

}  // namespace
}  // namespace yuragi::wind::field
