#pragma once

#include <cstddef>
#include <cstdint>

// How a tile is read, for kernel files and torus.cpp alike: always inlined, as engine/base/kernel.hpp asks.

namespace yuragi {

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

/// `values` holds 2^log2_size rows (along x) of 2^log2_size values.
[[gnu::always_inline]] inline float read_bilinear(const float* values, unsigned log2_size, std::uint32_t phase_x,
                                                  std::uint32_t phase_z) noexcept {
  const TorusCell x = torus_cell(phase_x, log2_size);
  const TorusCell z = torus_cell(phase_z, log2_size);
  const std::uint32_t row = z.first << log2_size;
  const std::uint32_t next_row = z.second << log2_size;
  const float north = between(values[row + x.first], values[row + x.second], x.fraction);
  const float south = between(values[next_row + x.first], values[next_row + x.second], x.fraction);
  return between(north, south, z.fraction);
}

}  // namespace yuragi
