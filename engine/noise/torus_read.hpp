#pragma once

#include <cstddef>
#include <cstdint>

// How a tile is read, for kernel files and torus.cpp alike: always inlined, as engine/base/kernel.hpp asks.

namespace yuragi::noise {

/// Where between which samples a phase is, on an axis of 2^log2_size samples.
struct TorusCell {
  std::uint32_t first;
  std::uint32_t second;  ///< the one behind the first, around the torus
  float fraction;        ///< from the first to the second, [0, 1)
};

[[gnu::always_inline]] inline TorusCell torus_cell(std::uint32_t phase, unsigned log2_size) noexcept {
  const std::uint32_t first = phase >> (32U - log2_size);
  const std::uint32_t second = (first + 1U) & ((1U << log2_size) - 1U);
  // The highest 24 bits below the sample's number: as many as a float holds exactly.
  const auto below = static_cast<std::int32_t>((phase << log2_size) >> 8U);
  return {first, second, static_cast<float>(below) * 0x1p-24F};
}

[[gnu::always_inline]] inline float between(float first, float second, float fraction) noexcept {
  return first + fraction * (second - first);
}

/// The four samples around a place on a torus of 2^log2_size rows (along x) of 2^log2_size samples, and where between
/// them it is.
struct TorusCorners {
  std::uint32_t north_west, north_east, south_west, south_east;
  float fraction_x, fraction_z;
};

[[gnu::always_inline]] inline TorusCorners torus_corners(unsigned log2_size, std::uint32_t phase_x,
                                                         std::uint32_t phase_z) noexcept {
  const TorusCell x = torus_cell(phase_x, log2_size);
  const TorusCell z = torus_cell(phase_z, log2_size);
  const std::uint32_t row = z.first << log2_size;
  const std::uint32_t next_row = z.second << log2_size;
  return {row + x.first, row + x.second, next_row + x.first, next_row + x.second, x.fraction, z.fraction};
}

[[gnu::always_inline]] inline float read_corners(const float* values, const TorusCorners& at) noexcept {
  const float north = between(values[at.north_west], values[at.north_east], at.fraction_x);
  const float south = between(values[at.south_west], values[at.south_east], at.fraction_x);
  return between(north, south, at.fraction_z);
}

[[gnu::always_inline]] inline float read_bilinear(const float* values, unsigned log2_size, std::uint32_t phase_x,
                                                  std::uint32_t phase_z) noexcept {
  return read_corners(values, torus_corners(log2_size, phase_x, phase_z));
}

}  // namespace yuragi::noise
