#include "engine/scenes/cloth_noise.hpp"

#include <array>

namespace yuragi {
namespace {

constexpr std::size_t kClothTileSamples = 128;

/// Of noise of variance 1: what is beyond 2.2 standard deviations is cut.
constexpr float kClothNoiseScale = 0.45F;

/// Where the whole cloth reads it, far from any column.
constexpr std::array kSwellPlace_m = {1618.034F, -809.017F};

}  // namespace

ClothNoise::ClothNoise(const ParameterValues& values, std::uint64_t seed, std::span<const float> x_m,
                       std::span<const float> z_m, SimdRow row)
    : row_(row),
      noise_({.period_m = values.number("tile_period"),
              .samples = kClothTileSamples,
              .beta = values.number("beta"),
              .seed = seed}),
      columns_(noise_.places(x_m, z_m)),
      swell_(noise_.places(std::span(kSwellPlace_m).first(1), std::span(kSwellPlace_m).last(1))) {}

void ClothNoise::sample(std::span<float> out) const noexcept {
  noise_.sample(columns_, row_, out, kClothNoiseScale, 0.0F, -1.0F, 1.0F);
}

float ClothNoise::swell() const noexcept {
  float value = 0.0F;
  noise_.sample(swell_, row_, std::span(&value, 1), kClothNoiseScale, 0.0F, -1.0F, 1.0F);
  return value;
}

}  // namespace yuragi
