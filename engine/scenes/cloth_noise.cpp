#include "engine/scenes/cloth_noise.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace yuragi {
namespace {

// The tiles are read along no simple slope, so that a cloth whose waves always run the same way sees none come round:
// by 67.5 degrees (cosine and sine), whose slope on the first tile is 1 + sqrt(2), and on the second, which is turned
// by another radian, is as far from any simple one.
constexpr double kAlongNoiseX = 0.3826834323650898;
constexpr double kAlongNoiseZ = 0.9238795325112867;

/// Brings the difference over half a wave back to variance 1: it is 2 - 2 J0(pi) of a noise whose waves have all
/// directions and that length.
constexpr float kUnitDifference = 0.619F;

/// 2.2 tanh(n / 2.2) by its continued fraction, which reaches 2.2 at three times that, with a slope of 1 at most.
float saturated(float noise) noexcept {
  constexpr auto kLargest = static_cast<float>(ClothNoise::kLargest);
  const float x = std::clamp(noise * (1.0F / kLargest), -3.0F, 3.0F);
  const float square = x * x;
  return kLargest * x * (27.0F + square) / (27.0F + 9.0F * square);
}

}  // namespace

ClothNoise::ClothNoise(double shortest_m, double longest_m, std::uint64_t seed, SimdRow row)
    : row_(row), half_wave_m_(0.5 * std::sqrt(shortest_m * longest_m)), noise_(CarriedNoise::band(shortest_m, longest_m, seed)) {}

ClothPlaces ClothNoise::places(std::span<const float> x_m, std::span<const float> z_m) const {
  std::vector<float> noise_x_m(x_m.size());
  std::vector<float> noise_z_m(z_m.size());
  for (std::size_t i = 0; i < x_m.size(); ++i) {
    const auto x = static_cast<double>(x_m[i]);
    const auto z = static_cast<double>(z_m[i]);
    noise_x_m[i] = static_cast<float>(kAlongNoiseX * x - kAlongNoiseZ * z);
    noise_z_m[i] = static_cast<float>(kAlongNoiseZ * x + kAlongNoiseX * z);
  }
  return {.here = noise_.places(noise_x_m, noise_z_m), .behind = {}};
}

ClothPlaces ClothNoise::places_along_x(std::span<const float> x_m, std::span<const float> z_m) {
  std::vector<float> behind_m(x_m.begin(), x_m.end());
  for (float& each_m : behind_m) each_m -= static_cast<float>(half_wave_m_);
  behind_.resize(x_m.size());
  return {.here = places(x_m, z_m).here, .behind = places(behind_m, z_m).here};
}

void ClothNoise::shift(double toward_x_m_s, double toward_z_m_s, double dt_s) noexcept {
  noise_.shift(kAlongNoiseX * toward_x_m_s - kAlongNoiseZ * toward_z_m_s,
               kAlongNoiseZ * toward_x_m_s + kAlongNoiseX * toward_z_m_s, dt_s);
}

void ClothNoise::sample(const ClothPlaces& places, std::span<float> out) noexcept {
  noise_.sample(places.here, row_, out);
  if (places.behind.size() == out.size()) {
    noise_.sample(places.behind, row_, behind_);
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = kUnitDifference * (out[i] - behind_[i]);
  }
  for (float& value : out) value = saturated(value);
}

double ClothNoise::largest_change(double speed_m_s, double dt_s) const noexcept {
  constexpr double kOfBoth = 2.0 * static_cast<double>(kUnitDifference);
  return std::min(kOfBoth * noise_.largest_change(speed_m_s, 0.0, dt_s), 2.0 * kLargest);
}

}  // namespace yuragi
