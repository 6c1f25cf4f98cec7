#include "engine/scenes/cloth_noise.hpp"

#include <algorithm>
#include <vector>

namespace yuragi::scenes {
namespace {

// The tiles are read along an irrational slope, so that a cloth whose waves always run the same way never shows a
// repeat: 67.5 degrees (cosine and sine), whose slope on the first tile is 1 + sqrt(2); on the second tile, turned by
// another radian, it is as far from a simple slope.
constexpr double kAlongNoiseX = 0.3826834323650898;
constexpr double kAlongNoiseZ = 0.9238795325112867;

}  // namespace

ClothNoise::ClothNoise(double shortest_m, double longest_m, std::uint64_t seed, SimdRow row)
    : row_(row), noise_(CarriedNoise::band(shortest_m, longest_m, seed)) {}

CarriedPlaces ClothNoise::places(std::span<const float> x_m, std::span<const float> z_m) const {
  std::vector<float> noise_x_m(x_m.size());
  std::vector<float> noise_z_m(z_m.size());
  for (std::size_t i = 0; i < x_m.size(); ++i) {
    const auto x = static_cast<double>(x_m[i]);
    const auto z = static_cast<double>(z_m[i]);
    noise_x_m[i] = static_cast<float>(kAlongNoiseX * x - kAlongNoiseZ * z);
    noise_z_m[i] = static_cast<float>(kAlongNoiseZ * x + kAlongNoiseX * z);
  }
  return noise_.places(noise_x_m, noise_z_m);
}

void ClothNoise::shift(double toward_x_m_s, double toward_z_m_s, double dt_s) noexcept {
  noise_.shift(kAlongNoiseX * toward_x_m_s - kAlongNoiseZ * toward_z_m_s,
               kAlongNoiseZ * toward_x_m_s + kAlongNoiseX * toward_z_m_s, dt_s);
}

void ClothNoise::read(const CarriedPlaces& places, std::span<float> out) const noexcept {
  noise_.sample(places, row_, out);
}

void ClothNoise::sample(const CarriedPlaces& places, std::span<float> out) const noexcept {
  read(places, out);
  for (float& value : out) value = saturated(value);
}

double ClothNoise::largest_read_change(double speed_m_s, double dt_s) const noexcept {
  return noise_.largest_change(speed_m_s, 0.0, dt_s);
}

double ClothNoise::largest_change(double speed_m_s, double dt_s) const noexcept {
  return std::min(largest_read_change(speed_m_s, dt_s), 2.0 * kLargest);
}

}  // namespace yuragi::scenes
