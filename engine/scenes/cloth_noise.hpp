#pragma once

#include <cstdint>
#include <span>

#include "engine/base/parameter.hpp"
#include "engine/base/simd_row.hpp"
#include "engine/scenes/carried_noise.hpp"

namespace yuragi {

/// The noise that moves a cloth: one that the wind carries over it (CarriedNoise). Each column reads it where it is;
/// and the whole cloth reads it once, far away, for what sways it as one: another noise, as good as independent.
/// Numbers from -1 to 1. Allocates when it is made. Thread-safe: no. Realtime-safe: yes.
class ClothNoise {
 public:
  /// Reads `tile_period` and `beta` of the scene's parameters; x and z: where the columns are on the noise.
  ClothNoise(const ParameterValues& values, std::uint64_t seed, std::span<const float> x_m, std::span<const float> z_m,
             SimdRow row);

  /// The noise goes on as the wind goes in dt_s.
  void shift(double toward_x_m_s, double toward_z_m_s, double dt_s) noexcept {
    noise_.shift(toward_x_m_s, toward_z_m_s, dt_s);
  }

  /// One value a column.
  void sample(std::span<float> out) const noexcept;

  /// One value for the whole cloth.
  float swell() const noexcept;

 private:
  SimdRow row_;
  CarriedNoise noise_;
  CarriedPlaces columns_, swell_;
};

}  // namespace yuragi
