// What the motions of cloths are made of: waves, how strong they are, and what swings.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "engine/operators/oscillator_job.hpp"
#include "engine/scenes/cloth_strength.hpp"
#include "engine/scenes/cloth_swing.hpp"
#include "engine/scenes/cloth_waves.hpp"

namespace yuragi::scenes {
namespace {

constexpr double kPartTick_s = 1.0 / 60.0;
constexpr std::size_t kClothPlaces = 20'000;
constexpr double kApart_m = 0.05;

/// A line along x.
std::vector<float> along_x() {
  std::vector<float> x_m(kClothPlaces);
  for (std::size_t i = 0; i < kClothPlaces; ++i) {
    x_m[i] = static_cast<float>(kApart_m * static_cast<double>(i));
  }
  return x_m;
}

/// How much of the variance is in waves of this length and longer, as a line reads them: of what is left when means
/// over a third of it are taken.
double long_part(const std::vector<float>& values, double length_m) {
  const auto width = static_cast<std::size_t>(length_m / 3.0 / kApart_m);
  double all = 0.0;
  double slow = 0.0;
  for (std::size_t i = 0; i + 3 * width < values.size(); ++i) {
    double mean = 0.0;
    for (std::size_t j = 0; j < 3 * width; ++j) mean += static_cast<double>(values[i + j]);
    slow += std::pow(mean / static_cast<double>(3 * width), 2);
    all += static_cast<double>(values[i] * values[i]);
  }
  return slow / all;
}

/// The waves along that line.
ClothWaves waves_along_x() {
  static constexpr std::array kNoneAside = {0.0F};
  return {
      1.2, 2.4, {.first_m = 0.0, .step_m = kApart_m, .rows = kClothPlaces, .across_m = kNoneAside}, 3, best_simd_row()};
}

void expect_saturated(std::span<const float> values) {
  double squares = 0.0;
  for (const float value : values) {
    EXPECT_LE(std::abs(value), static_cast<float>(ClothNoise::kLargest));
    squares += static_cast<double>(value * value);
  }
  EXPECT_NEAR(squares / kClothPlaces, 0.8, 0.15);  // 2.2 tanh(n / 2.2) of a normal n has 0.77
}

TEST(ClothNoise, StaysWithinItsLargestAndHasVarianceNearOne) {
  const ClothNoise noise(1.2, 2.4, 3, best_simd_row());
  std::vector<float> values(kClothPlaces);
  noise.sample(noise.places(along_x(), std::vector<float>(kClothPlaces, 0.3F)), values);
  expect_saturated(values);
}

TEST(ClothNoise, IsSaturatedAsByAHyperbolicTangent) {
  for (int i = -800; i < 800; ++i) {
    const float value = 0.01F * static_cast<float>(i);
    EXPECT_NEAR(ClothNoise::saturated(value), 2.2 * std::tanh(static_cast<double>(value) / 2.2), 0.06);
    EXPECT_LE(ClothNoise::saturated(value + 0.01F) - ClothNoise::saturated(value), 0.01F + 1e-6F);
  }
}

TEST(ClothWaves, HaveTheVarianceOfANoiseButFewLongWaves) {
  const ClothNoise noise(1.2, 2.4, 3, best_simd_row());
  std::vector<float> any(kClothPlaces);
  noise.sample(noise.places(along_x(), std::vector<float>(kClothPlaces, 0.0F)), any);
  ClothWaves waves = waves_along_x();
  waves.sample();
  expect_saturated(waves.values());
  const std::vector<float> running(waves.values().begin(), waves.values().end());
  EXPECT_LT(long_part(running, 4.8), 0.25 * long_part(any, 4.8));
}

TEST(ClothWaves, RunAlongAndChangeNoFasterThanTheySay) {
  ClothWaves waves = waves_along_x();
  waves.sample();
  const std::vector<float> before(waves.values().begin(), waves.values().end());
  std::vector<float> last = before;
  const double bound = waves.largest_change(6.0, kPartTick_s);
  for (int tick = 0; tick < 60; ++tick) {
    waves.shift(6.0, kPartTick_s);
    waves.sample();
    for (std::size_t i = 0; i < kClothPlaces; ++i) ASSERT_LE(std::abs(waves.values()[i] - last[i]), bound);
    last.assign(waves.values().begin(), waves.values().end());
  }
  constexpr std::size_t kRun = 120;  // 6 m
  for (std::size_t i = kRun; i < kClothPlaces; i += 50) EXPECT_NEAR(last[i], before[i - kRun], 2e-3);
  EXPECT_LT(bound, 2.0 * ClothNoise::kLargest);
}

TEST(ClothStrength, FollowsTheWindNoFasterThanItSaysAndComesToRest) {
  ClothStrength strength;
  double before = 0.0;
  for (int tick = 0; tick < 600; ++tick) {
    strength.step(tick / 40 % 2 == 0 ? 60.0 : 0.0, 4.0, kPartTick_s);
    EXPECT_LE(std::abs(strength.value() - before), ClothStrength::largest_step(kPartTick_s));
    before = strength.value();
  }
  for (int tick = 0; tick < 600; ++tick) strength.step(4.0, 4.0, kPartTick_s);
  EXPECT_NEAR(strength.value(), 0.5, 1e-6);
  for (int tick = 0; tick < 600; ++tick) strength.step(0.0, 4.0, kPartTick_s);
  EXPECT_EQ(strength.value(), 0.0);
}

TEST(ClothSwing, SwingsAsTheExactOscillatorDoes) {
  constexpr double kHz = 0.5;
  constexpr double kDamping = 0.2;
  const operators::OscillatorStep exact = operators::OscillatorStep::exact(kHz, kDamping, kPartTick_s);
  ClothSwing swing;
  double value = 0.0;
  double rate = 0.0;
  for (int tick = 0; tick < 300; ++tick) {
    const double target = tick < 100 ? 1.0 : -0.3;
    swing.step(target, kHz, 4.0 * std::numbers::pi * kHz * kDamping, {10.0, 100.0}, kPartTick_s);
    const double distance = value - target;
    value = target + exact.q_from_e * distance + exact.q_from_v * rate;
    rate = exact.v_from_e * distance + exact.v_from_v * rate;
    EXPECT_NEAR(swing.value, value, 2e-3);
  }
}

TEST(ClothSwing, StaysWithinItsLimitsAndComesToRest) {
  ClothSwing swing;
  double before = 0.0;
  for (int tick = 0; tick < 600; ++tick) {
    // A frequency that is high on the way out and low on the way back would lift it ever farther.
    const double hz = swing.value * swing.rate_per_s > 0.0 ? 0.2 : 3.0;
    swing.step(tick / 30 % 2 == 0 ? 1.0 : -1.0, hz, 0.0, {1.5, 6.0}, kPartTick_s);
    EXPECT_LE(std::abs(swing.value), 1.5);
    EXPECT_LE(std::abs(swing.value - before), 6.0 * kPartTick_s + 1e-12);
    before = swing.value;
  }
  for (int tick = 0; tick < 1200; ++tick) swing.step(0.0, 0.5, 2.0, {1.5, 6.0}, kPartTick_s);
  EXPECT_EQ(swing.value, 0.0);
  EXPECT_EQ(swing.rate_per_s, 0.0);
}

}  // namespace
}  // namespace yuragi::scenes
