#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "engine/base/simd_row.hpp"
#include "engine/base/state_pass.hpp"
#include "engine/scenes/carried_noise.hpp"

namespace yuragi::scenes {

/// A noise of one band of wavelengths (CarriedNoise::band) that moves over a cloth, or over the ground below it. Mean
/// 0. Its coordinates are the caller's, metres. Allocates when it is made and in places(). Thread-safe: no.
/// Realtime-safe: the rest.
class ClothNoise {
 public:
  /// Waves of shortest_m to longest_m, at least an octave apart.
  ClothNoise(double shortest_m, double longest_m, std::uint64_t seed, SimdRow row);

  /// The places at which to read it.
  CarriedPlaces places(std::span<const float> x_m, std::span<const float> z_m) const;

  /// Moves it toward +x and +z for dt_s.
  void shift(double toward_x_m_s, double toward_z_m_s, double dt_s) noexcept;

  /// One value a place, of variance 1.
  void read(const CarriedPlaces& places, std::span<float> out) const noexcept;
  /// The same, saturated: of variance near 0.8.
  void sample(const CarriedPlaces& places, std::span<float> out) const noexcept;

  /// The maximum change of a value that is read, or sampled, in a tick, at up to speed_m_s.
  double largest_read_change(double speed_m_s, double dt_s) const noexcept;
  double largest_change(double speed_m_s, double dt_s) const noexcept;

  /// The limit of saturated values, in both directions.
  static constexpr double kLargest = 2.2;

  /// 2.2 tanh(value / 2.2) by its continued fraction, which reaches 2.2 at three times that. Its slope is 1 at most.
  static float saturated(float value) noexcept {
    constexpr auto kMost = static_cast<float>(kLargest);
    const float x = std::clamp(value * (1.0F / kMost), -3.0F, 3.0F);
    const float square = x * x;
    return kMost * x * (27.0F + square) / (27.0F + 9.0F * square);
  }

  void list_state(StatePass& pass) { pass(noise_); }

 private:
  SimdRow row_;
  CarriedNoise noise_;
};

}  // namespace yuragi::scenes
