#include "engine/noise/line_cut.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "engine/noise/spectral_noise.hpp"
#include "tests/engine/noise/periodogram.hpp"

namespace yuragi::noise {
namespace {

constexpr double kLinePeriod_m = 256.0;

double turns(std::uint32_t phase) {
  return static_cast<double>(static_cast<std::int32_t>(phase)) / 4294967296.0;
}

TEST(LineCutTest, GoesADistanceAlongALineOfGoldenSlope) {
  EXPECT_NEAR(LineCut::kEast * LineCut::kEast + LineCut::kSouth * LineCut::kSouth, 1.0, 1e-15);
  EXPECT_NEAR(LineCut::kEast / LineCut::kSouth, std::numbers::phi, 1e-15);
  LineCut cut;
  for (int i = 0; i < 1000; ++i) cut.add(0.05, kLinePeriod_m);
  const TorusPhase expected = LineCut::apart(50.0, kLinePeriod_m);
  EXPECT_NEAR(turns(cut.phase().x - expected.x), 0.0, 1e-9);
  EXPECT_NEAR(turns(cut.phase().z - expected.z), 0.0, 1e-9);
  EXPECT_NEAR(turns(cut.phase().x) * kLinePeriod_m, 50.0 * LineCut::kEast, 1e-6);
}

TEST(LineCutTest, GoesBackToWhereItCameFrom) {
  LineCut cut;
  for (const double way_m : {3.7, 1e6, 0.01}) cut.add(way_m, kLinePeriod_m);
  for (const double way_m : {-0.01, -1e6, -3.7}) cut.add(way_m, kLinePeriod_m);
  EXPECT_NEAR(turns(cut.phase().x), 0.0, 1e-9);
  EXPECT_NEAR(turns(cut.phase().z), 0.0, 1e-9);
}

TEST(LineCutTest, MissesItselfByAtLeastAsMuchAsItSays) {
  // Each time that it comes round in x: how far is it then from all the places where it came round before? Since the
  // line is straight, that is its distance from where it began.
  LineCut cut;
  double nearest = 1.0;
  int first_within_a_sample = 0;
  for (int round = 1; round <= 10'000; ++round) {
    cut.add(kLinePeriod_m / LineCut::kEast, kLinePeriod_m);
    ASSERT_NEAR(turns(cut.phase().x), 0.0, 1e-8);
    const double missed = std::abs(turns(cut.phase().z));
    nearest = std::min(nearest, missed * round);
    if (first_within_a_sample == 0 && missed * 512.0 < 1.0) first_within_a_sample = round;
  }
  EXPECT_GT(nearest, 0.38);
  EXPECT_EQ(first_within_a_sample, 233);
}

/// What stands along the line, a sample each `step_m`.
std::vector<float> along(const Tile2& tile, std::size_t count, double step_m) {
  std::vector<float> values;
  LineCut cut;
  for (std::size_t i = 0; i < count; ++i) {
    values.push_back(read_noise(tile, cut.phase()));
    cut.add(step_m, kLinePeriod_m);
  }
  return values;
}

TEST(LineCutTest, ItsLongestRepeatIsPoorWhereARowRepeatsExactly) {
  const Tile2 tile = make_noise_2d({.size = 256, .seed = 2}).value();
  const std::vector<float> line = along(tile, std::size_t{100} * 256, 1.0);
  const auto correlation_at = [&line](std::size_t lag) {
    double both = 0.0;
    double first = 0.0;
    double second = 0.0;
    for (std::size_t i = 0; i + lag < line.size(); ++i) {
      const auto a = static_cast<double>(line[i]);
      const auto b = static_cast<double>(line[i + lag]);
      both += a * b;
      first += a * a;
      second += b * b;
    }
    return both / std::sqrt(first * second);
  };
  // A row comes back whole after 256 samples. The line, in 50 times that way, never comes nearer to what it was than
  // neighbouring rows are to one another; after 34 times around (40 periods) it passes within 3.4 samples of itself.
  double best = 0.0;
  for (std::size_t lag = 128; lag < std::size_t{40} * 256; ++lag) best = std::max(best, correlation_at(lag));
  EXPECT_LT(best, 0.95);
  for (std::size_t lag = 128; lag < std::size_t{12} * 256; ++lag) ASSERT_LT(correlation_at(lag), 0.8) << lag;
}

TEST(LineCutTest, HasTheSpectrumThatTransectAsksFor) {
  // Hann windows of four periods' way through a tile of 1024 samples, from 4 cycles an edge to 32: finer than that,
  // reading between the samples takes some power away.
  constexpr std::size_t kWindow = 4096;
  for (const double beta : {1.0, 5.0 / 3.0, 2.0}) {
    std::vector<double> mean(kWindow / 2 + 1, 0.0);
    for (std::uint64_t seed = 0; seed < 2; ++seed) {
      const Tile2 tile = make_noise_2d({.size = 1024, .beta = beta, .seed = seed}).value();
      const std::vector<float> line = along(tile, 32 * kWindow, kLinePeriod_m / 1024.0);
      fft::RealFft fft(1, kWindow);
      for (std::size_t begin = 0; begin < line.size(); begin += kWindow) {
        for (std::size_t i = 0; i < kWindow; ++i) {
          const double turn = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(kWindow);
          fft.samples()[i] = 0.5 * (1.0 - std::cos(turn)) * static_cast<double>(line[begin + i]);
        }
        fft.forward();
        for (std::size_t k = 0; k < mean.size(); ++k) mean[k] += std::norm(fft.spectrum()[k]);
      }
    }
    EXPECT_NEAR(test::falling_exponent(mean, 16, 128), beta, 0.1) << "beta " << beta;
  }
}

}  // namespace
}  // namespace yuragi::noise
