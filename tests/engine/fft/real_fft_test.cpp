#include "engine/fft/real_fft.hpp"

#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "engine/math/philox.hpp"

namespace yuragi::fft {
namespace {

void fill_with_normals(std::span<double> samples, std::uint64_t seed) {
  const math::RandomStream random(seed, math::stream_id("real fft test"));
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = random.normal(i);
}

TEST(RealFft, ForwardIsTheSumOfTheDefinition) {
  for (const std::size_t size : {std::size_t{8}, std::size_t{9}}) {
    RealFft fft(1, size);
    fill_with_normals(fft.samples(), 1);
    fft.forward();
    for (std::size_t k = 0; k < fft.row_modes(); ++k) {
      std::complex<double> sum = 0.0;
      for (std::size_t x = 0; x < size; ++x) {
        sum += fft.samples()[x] *
               std::polar(1.0, -2.0 * std::numbers::pi * static_cast<double>(k * x) / static_cast<double>(size));
      }
      EXPECT_NEAR(std::abs(fft.spectrum()[k] - sum), 0.0, 1e-13);
    }
  }
}

TEST(RealFft, AModeOfTheHalfSpectrumIsItsWave) {
  // kx = 3, kz = -2 (stored as size - 2) of a square: 2 cos(2 pi (3 x - 2 z) / size).
  constexpr std::size_t kSize = 16;
  RealFft fft(2, kSize);
  fft.spectrum()[(kSize - 2) * fft.row_modes() + 3] = 1.0;
  fft.inverse();
  for (std::size_t z = 0; z < kSize; ++z) {
    for (std::size_t x = 0; x < kSize; ++x) {
      const double phase =
          2.0 * std::numbers::pi * (3.0 * static_cast<double>(x) - 2.0 * static_cast<double>(z)) / kSize;
      EXPECT_NEAR(fft.samples()[z * kSize + x], 2.0 * std::cos(phase), 1e-13);
    }
  }
}

TEST(RealFft, ForwardThenInverseMultipliesByTheNumberOfSamples) {
  for (int dims = 1; dims <= 3; ++dims) {
    RealFft fft(dims, 16);
    fill_with_normals(fft.samples(), 2);
    const std::vector<double> before(fft.samples().begin(), fft.samples().end());
    ASSERT_EQ(before.size(), static_cast<std::size_t>(std::pow(16, dims)));
    fft.forward();
    fft.inverse();
    for (std::size_t i = 0; i < before.size(); ++i) {
      EXPECT_NEAR(fft.samples()[i], before[i] * static_cast<double>(before.size()), 1e-9);
    }
  }
}

TEST(RealFft, ForwardKeepsTheSamples) {
  for (int dims = 1; dims <= 3; ++dims) {
    RealFft fft(dims, 8);
    fill_with_normals(fft.samples(), 3);
    const std::vector<double> before(fft.samples().begin(), fft.samples().end());
    fft.forward();
    EXPECT_TRUE(std::equal(before.begin(), before.end(), fft.samples().begin()));
  }
}

TEST(RealFft, TwoObjectsComputeTheSameBits) {
  RealFft first(2, 64);
  RealFft second(2, 64);
  fill_with_normals(first.samples(), 4);
  fill_with_normals(second.samples(), 4);
  first.forward();
  second.forward();
  EXPECT_TRUE(std::equal(first.spectrum().begin(), first.spectrum().end(), second.spectrum().begin()));
}

TEST(RealFft, BuffersStartAtZeroAndSurviveAMove) {
  RealFft fft(1, 8);
  for (const double sample : fft.samples()) EXPECT_EQ(sample, 0.0);
  for (const auto mode : fft.spectrum()) EXPECT_EQ(mode, 0.0);
  fft.samples()[0] = 1.0;
  RealFft moved = std::move(fft);
  moved.forward();
  for (const auto mode : moved.spectrum()) EXPECT_EQ(mode, 1.0);
}

TEST(RealFft, ThreadsMayMakeAndUseTheirOwnTransformsAtOnce) {
  std::vector<double> sums(4, 0.0);
  std::vector<std::thread> threads;
  threads.reserve(sums.size());
  for (double& sum : sums) {
    threads.emplace_back([&sum] {
      for (std::size_t round = 0; round < 20; ++round) {
        RealFft fft(2, std::size_t{8} << (round % 3));
        fft.samples()[0] = 1.0;
        fft.forward();
        for (const auto mode : fft.spectrum()) sum += mode.real();
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  // Every mode of a single one is 1: rows x columns of the half spectra.
  const double expected = 7.0 * (8 * 5) + 7.0 * (16 * 9) + 6.0 * (32 * 17);
  for (const double sum : sums) EXPECT_DOUBLE_EQ(sum, expected);
}

TEST(RealFft, RefusesWhatItCannotHold) {
  EXPECT_THROW(RealFft(0, 8), std::invalid_argument);
  EXPECT_THROW(RealFft(4, 8), std::invalid_argument);
  EXPECT_THROW(RealFft(1, 0), std::invalid_argument);
  EXPECT_THROW(RealFft(1, (std::size_t{1} << 22U) + 1), std::invalid_argument);
  EXPECT_THROW(RealFft(2, std::size_t{1} << 22U), std::invalid_argument);
  EXPECT_THROW(RealFft(3, std::size_t{1} << 22U), std::invalid_argument);
}

}  // namespace
}  // namespace yuragi::fft
