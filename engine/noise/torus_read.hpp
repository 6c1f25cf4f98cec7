#pragma once

#include <cstddef>
#include <cstdint>

// Reads a tile, for kernel files and torus.cpp: always inlined, as engine/base/kernel.hpp requires.

namespace yuragi::noise {

/// The two samples next to a phase and the position between them, on an axis of 2^log2_size samples.
struct TorusCell {
  std::uint32_t first;
  std::uint32_t second;  ///< the one behind the first, around the torus
  float fraction;        ///< from the first to the second, [0, 1)
};

[[gnu::always_inline]] inline TorusCell torus_cell(std::uint32_t phase, unsigned log2_size) noexcept {
  const std::uint32_t first = phase >> (32U - log2_size);
  const std::uint32_t second = (first + 1U) & ((1U << log2_size) - 1U);
  // The 24 highest bits below the sample's number: as many as a float holds exactly.
  const auto below = static_cast<std::int32_t>((phase << log2_size) >> 8U);
  return {first, second, static_cast<float>(below) * 0x1p-24F};
}

[[gnu::always_inline]] inline float between(float first, float second, float fraction) noexcept {
  return first + fraction * (second - first);
}

/// The four samples around a place on a torus of 2^log2_size rows (along x) of 2^log2_size samples, and the position
/// between them.
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

/// The samples of a tile around a place.
struct TorusSamples {
  float north_west, north_east, south_west, south_east;
};

[[gnu::always_inline]] inline TorusSamples samples_at(const float* values, const TorusCorners& at) noexcept {
  return {values[at.north_west], values[at.north_east], values[at.south_west], values[at.south_east]};
}

[[gnu::always_inline]] inline TorusSamples mixed(const TorusSamples& a, float a_part, const TorusSamples& b,
                                                 float b_part) noexcept {
  return {a_part * a.north_west + b_part * b.north_west, a_part * a.north_east + b_part * b.north_east,
          a_part * a.south_west + b_part * b.south_west, a_part * a.south_east + b_part * b.south_east};
}

/// A value between four samples, and how much it rises from one sample to the next along x and along z.
struct TorusSlope {
  float value, along_x, along_z;
};

[[gnu::always_inline]] inline TorusSlope slope_at(const TorusSamples& at, float fraction_x, float fraction_z) noexcept {
  const float north_rise = at.north_east - at.north_west;
  const float south_rise = at.south_east - at.south_west;
  const float north = at.north_west + fraction_x * north_rise;
  const float south = at.south_west + fraction_x * south_rise;
  const float along_z = south - north;
  return {north + fraction_z * along_z, between(north_rise, south_rise, fraction_z), along_z};
}

/// A noise vector at a place: its part along a unit vector, its part to the left of that (from x to -z), and by how
/// much the first rises along the unit vector, per distance of two samples.
struct VectorReading {
  float along, across, rise;
};

[[gnu::always_inline]] inline VectorReading read_vector(const TorusSamples& x, const TorusSamples& z, float fraction_x,
                                                        float fraction_z, float ahead_x, float ahead_z) noexcept {
  const TorusSlope of_x = slope_at(x, fraction_x, fraction_z);
  const TorusSlope of_z = slope_at(z, fraction_x, fraction_z);
  return {ahead_x * of_x.value + ahead_z * of_z.value, ahead_z * of_x.value - ahead_x * of_z.value,
          ahead_x * ahead_x * of_x.along_x + ahead_x * ahead_z * (of_x.along_z + of_z.along_x) +
              ahead_z * ahead_z * of_z.along_z};
}

/// The same at one place of a vector's two tiles, cosine * first + sine * quarter; `quarter_x` null: the first alone.
struct VectorTiles {
  const float* x;
  const float* z;
  const float* quarter_x;
  const float* quarter_z;
  float cosine, sine;
};

[[gnu::always_inline]] inline VectorReading read_vector(const VectorTiles& tiles, const TorusCorners& at, float ahead_x,
                                                        float ahead_z) noexcept {
  TorusSamples x = samples_at(tiles.x, at);
  TorusSamples z = samples_at(tiles.z, at);
  if (tiles.quarter_x != nullptr) {
    x = mixed(x, tiles.cosine, samples_at(tiles.quarter_x, at), tiles.sine);
    z = mixed(z, tiles.cosine, samples_at(tiles.quarter_z, at), tiles.sine);
  }
  return read_vector(x, z, at.fraction_x, at.fraction_z, ahead_x, ahead_z);
}

}  // namespace yuragi::noise
