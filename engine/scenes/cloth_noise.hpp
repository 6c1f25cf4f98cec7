#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/simd_row.hpp"
#include "engine/scenes/carried_noise.hpp"

namespace yuragi {

/// Where a ClothNoise is read.
struct ClothPlaces {
  CarriedPlaces here;
  CarriedPlaces behind;  ///< half a wave behind; empty: only `here` counts
};

/// The waves that run over a cloth: a noise of one band of wavelengths (CarriedNoise::band) that is carried along, and
/// brought smoothly within kLargest. Its coordinates are those of the caller, metres along the cloth or over the
/// ground. Mean 0, variance somewhat below 1. Allocates when it is made and in places(). Thread-safe: no.
/// Realtime-safe: shift() and sample().
class ClothNoise {
 public:
  /// Never farther from 0 than this: what is beyond comes ever closer to it.
  static constexpr double kLargest = 2.2;

  /// Waves of shortest_m to longest_m, at least an octave apart.
  ClothNoise(double shortest_m, double longest_m, std::uint64_t seed, SimdRow row);

  /// Where it is to be read, so that its waves go in all directions.
  ClothPlaces places(std::span<const float> x_m, std::span<const float> z_m) const;

  /// Where it is to be read, so that its waves run along x: what counts is by how much it differs from half a wave
  /// behind. Waves that lie nearly along x, which a line along x reads as long ones, are missing.
  ClothPlaces places_along_x(std::span<const float> x_m, std::span<const float> z_m);

  /// It is carried toward +x and +z for dt_s.
  void shift(double toward_x_m_s, double toward_z_m_s, double dt_s) noexcept;

  /// One value a place.
  void sample(const ClothPlaces& places, std::span<float> out) noexcept;

  /// No more than this does a value change in a tick, while it is carried at no more than speed_m_s.
  double largest_change(double speed_m_s, double dt_s) const noexcept;

 private:
  SimdRow row_;
  double half_wave_m_;
  CarriedNoise noise_;
  std::vector<float> behind_;
};

}  // namespace yuragi
