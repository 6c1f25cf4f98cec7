#include "engine/scenes/cloth_noise.hpp"

#include <vector>

namespace yuragi {
namespace {

constexpr std::size_t kClothTileSamples = 256;

/// Of noise of variance 1: what is beyond 2.2 standard deviations is cut.
constexpr float kClothNoiseScale = 0.45F;

/// How far from the first noise the second is read, in both directions: no whole number of any period.
constexpr float kSecondPlace_m = 1618.034F;

std::vector<float> moved(std::span<const float> places_m, float by_m) {
  std::vector<float> moved_m(places_m.begin(), places_m.end());
  for (float& place_m : moved_m) place_m += by_m;
  return moved_m;
}

}  // namespace

ClothNoise::ClothNoise(const ParameterValues& values, std::uint64_t seed, std::span<const float> x_m,
                       std::span<const float> z_m, SimdRow row)
    : row_(row),
      noise_({.period_m = values.number("tile_period"),
              .samples = kClothTileSamples,
              .beta = values.number("beta"),
              .seed = seed}),
      first_(noise_.places(x_m, z_m)),
      second_(noise_.places(moved(x_m, kSecondPlace_m), moved(z_m, -0.5F * kSecondPlace_m))) {}

void ClothNoise::sample(Channel channel, std::span<float> out) const noexcept {
  noise_.sample(channel == kFirst ? first_ : second_, row_, out, kClothNoiseScale, 0.0F, -1.0F, 1.0F);
}

}  // namespace yuragi
