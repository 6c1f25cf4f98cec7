#include "engine/wind/turbulence/gust_variances.hpp"

#include <cmath>
#include <numbers>

#include "engine/math/portable.hpp"
#include "engine/noise/von_karman_corner.hpp"
#include "engine/wind/turbulence/von_karman_integrals.hpp"

namespace yuragi::wind::turbulence {

double centre_hz(const GustNoise::Octave& octave, double advection_m_s) noexcept {
  return std::numbers::sqrt2 * octave.from_rad_m * advection_m_s / (2.0 * std::numbers::pi);
}

GustVariances gust_variances(const GustNoise& noise, double intensity, double length_m) noexcept {
  // On the ground, in two dimensions: the part above |k| of the variance of one component.
  const auto above = [length_m](double rad_m) {
    const double reduced = noise::kVonKarmanCorner * length_m * rad_m;
    const double scalar = 1.0 / math::cube_root(1.0 + reduced * reduced);
    return scalar * (7.0 - scalar * scalar * scalar) / 6.0;
  };
  // Along the way, in one: at a wind of 1 m/s a wavenumber k is a frequency k / 2 pi.
  const auto along_way = [length_m](double from_rad_m, double to_rad_m) {
    return von_karman_share(from_rad_m / (2.0 * std::numbers::pi), to_rad_m / (2.0 * std::numbers::pi), length_m);
  };

  GustVariances shares{};
  const auto& octaves = noise.octaves();
  for (std::size_t which = 0; which < 2; ++which) {
    const std::size_t way = which * GustNoise::kWayOctaves;
    const std::size_t tile = GustNoise::kFirstTileOctave + which * GustNoise::kTileOctaves;
    // Waves too long for the tiles belong to the way. Its first octave also represents all longer waves.
    const double longest_rad_m = octaves[tile].from_rad_m;
    const double scale = (1.0 - above(longest_rad_m)) / along_way(0.0, longest_rad_m);
    for (std::size_t i = 0; i < GustNoise::kWayOctaves; ++i) {
      const GustNoise::Octave& octave = octaves[way + i];
      shares[way + i] = scale * along_way(i == 0 ? 0.0 : octave.from_rad_m, octave.to_rad_m);
    }
    for (std::size_t i = 0; i < GustNoise::kTileOctaves; ++i) {
      const GustNoise::Octave& octave = octaves[tile + i];
      shares[tile + i] = above(octave.from_rad_m) - above(octave.to_rad_m);
    }
  }
  for (std::size_t i = 0; i < shares.size(); ++i) shares[i] *= octaves[i].share * intensity * intensity;
  return shares;
}

}  // namespace yuragi::wind::turbulence
