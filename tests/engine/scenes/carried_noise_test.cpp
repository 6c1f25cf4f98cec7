#include "engine/scenes/carried_noise.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace yuragi::scenes {
namespace {

constexpr std::size_t kPlaces = 20'000;

/// A line along which the noise is read every 5 cm.
struct Line {
  std::vector<float> x_m, z_m;
  Line() : x_m(kPlaces), z_m(kPlaces) {
    for (std::size_t i = 0; i < kPlaces; ++i) {
      x_m[i] = 0.05F * 0.8F * static_cast<float>(i);
      z_m[i] = 0.05F * 0.6F * static_cast<float>(i);
    }
  }
};

std::vector<float> read(const CarriedNoise& noise) {
  const Line line;
  std::vector<float> values(kPlaces);
  noise.sample(noise.places(line.x_m, line.z_m), best_simd_row(), values);
  return values;
}

TEST(CarriedNoise, ABandHasVarianceOneAsItIsRead) {
  const CarriedNoise noise(CarriedNoise::band(1.5, 3.0, 7));
  double squares = 0.0;
  for (const float value : read(noise)) squares += static_cast<double>(value * value);
  EXPECT_NEAR(squares / kPlaces, 1.0, 0.1);
}

TEST(CarriedNoise, ABandHasNoWavesShorterThanItsShortest) {
  // Along a line a wave looks as long as it is, or longer. The power of each wave length by its own Fourier sum.
  const std::vector<float> values = read(CarriedNoise(CarriedNoise::band(1.5, 3.0, 7)));
  double within = 0.0;
  double shorter = 0.0;
  constexpr double kLength_m = 0.05 * kPlaces;
  for (int wave = 100; wave < 2000; ++wave) {
    const double length_m = kLength_m / wave;
    double real = 0.0;
    double imaginary = 0.0;
    for (std::size_t i = 0; i < kPlaces; ++i) {
      const double phase = 2.0 * M_PI * wave * static_cast<double>(i) / kPlaces;
      const double window = 0.5 - 0.5 * std::cos(2.0 * M_PI * static_cast<double>(i) / kPlaces);
      real += window * static_cast<double>(values[i]) * std::cos(phase);
      imaginary += window * static_cast<double>(values[i]) * std::sin(phase);
    }
    (length_m < 1.4 ? shorter : within) += real * real + imaginary * imaginary;
  }
  EXPECT_LT(shorter, 0.01 * within);
}

TEST(CarriedNoise, ABandIsCarriedWithoutLossAtAnySpeed) {
  CarriedNoise noise(CarriedNoise::band(1.5, 3.0, 7));
  const Line line;
  const CarriedPlaces places = noise.places(line.x_m, line.z_m);
  std::vector<float> before(kPlaces);
  noise.sample(places, best_simd_row(), before);
  // 0.25 m along the line: five places on.
  for (int tick = 0; tick < 60; ++tick) noise.shift(0.8 * 0.25, 0.6 * 0.25, 1.0 / 60.0);
  std::vector<float> after(kPlaces);
  noise.sample(places, best_simd_row(), after);
  for (std::size_t i = 5; i < kPlaces; ++i) ASSERT_NEAR(after[i], before[i - 5], 2e-3) << i;
}

}  // namespace
}  // namespace yuragi::scenes
