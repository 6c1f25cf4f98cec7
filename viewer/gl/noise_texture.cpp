#include "viewer/gl/noise_texture.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "engine/math/philox.hpp"

namespace yuragi::viewer::gl {
namespace {

constexpr std::size_t kSize = 256;
constexpr std::array<std::size_t, 6> kCellsPerOctave{4, 8, 16, 32, 64, 128};

float smooth(float t) {
  return t * t * (3.0F - 2.0F * t);
}

/// Adds random values on a lattice of cells x cells, smoothly interpolated.
void add_octave(std::size_t cells, float weight, std::vector<float>& tile) {
  const math::RandomStream random(0, math::stream_id("viewer noise") + cells);
  std::vector<float> values(cells * cells);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(random.uniform(i));
  const auto lattice = [&](std::size_t x, std::size_t y) { return values[y % cells * cells + x % cells]; };
  const std::size_t step = kSize / cells;
  for (std::size_t y = 0; y < kSize; ++y) {
    const float fy = smooth(static_cast<float>(y % step) / static_cast<float>(step));
    for (std::size_t x = 0; x < kSize; ++x) {
      const float fx = smooth(static_cast<float>(x % step) / static_cast<float>(step));
      const std::size_t cx = x / step;
      const std::size_t cy = y / step;
      const float low = lattice(cx, cy) + fx * (lattice(cx + 1, cy) - lattice(cx, cy));
      const float high = lattice(cx, cy + 1) + fx * (lattice(cx + 1, cy + 1) - lattice(cx, cy + 1));
      tile[y * kSize + x] += weight * (low + fy * (high - low));
    }
  }
}

/// The tile, from 0 to 1.
std::vector<float> make_tile_values() {
  std::vector<float> tile(kSize * kSize, 0.0F);
  float weight = 1.0F;
  for (const std::size_t cells : kCellsPerOctave) {
    add_octave(cells, weight, tile);
    weight *= 0.55F;
  }

  // Scaled to the whole range.
  const auto [low, high] = std::minmax_element(tile.begin(), tile.end());
  const float from = *low;
  const float range = *high - *low;
  for (float& value : tile) value = (value - from) / range;
  return tile;
}

/// Made once: three textures have it.
const std::vector<float>& tile_values() {
  static const std::vector<float> tile = make_tile_values();
  return tile;
}

std::uint8_t byte_of(float value) {
  return static_cast<std::uint8_t>(255.0F * std::clamp(value, 0.0F, 1.0F));
}

/// A tile of texels that `texel_at(tile, x, y)` makes, an array of `kChannels` values from 0 to 1 each.
template <std::size_t kChannels, class TexelAt>
Texture made_of_noise(GLint kept_as, GLenum format, TexelAt&& texel_at) {
  const std::vector<float>& tile = tile_values();
  std::vector<std::uint8_t> texels;
  texels.reserve(kChannels * tile.size());
  for (std::size_t y = 0; y < kSize; ++y) {
    for (std::size_t x = 0; x < kSize; ++x) {
      for (const float value : texel_at(tile, x, y)) texels.push_back(byte_of(value));
    }
  }
  return make_tile(kept_as, format, kSize, texels);
}

float value_at(const std::vector<float>& tile, std::size_t x, std::size_t y) {
  return tile[y % kSize * kSize + x % kSize];
}

/// The mean of a square of texels.
float mean_at(const std::vector<float>& tile, std::size_t x, std::size_t y, std::size_t side) {
  float sum = 0.0F;
  for (std::size_t i = 0; i < side; ++i) {
    for (std::size_t k = 0; k < side; ++k) sum += value_at(tile, x + i, y + k);
  }
  return sum / static_cast<float>(side * side);
}

}  // namespace

Texture make_noise_texture() {
  return made_of_noise<1>(GL_R8, GL_RED, [](const std::vector<float>& tile, std::size_t x, std::size_t y) {
    return std::array{value_at(tile, x, y)};
  });
}

Texture make_turf_texture() {
  constexpr std::size_t kFiner = 8;
  constexpr std::size_t kBroad = 16;
  return made_of_noise<3>(GL_RGB8, GL_RGB, [](const std::vector<float>& tile, std::size_t x, std::size_t y) {
    const float clumps = mean_at(tile, kFiner * x, kFiner * y, kFiner);
    const float around = mean_at(tile, x + kSize - kBroad / 2, y + kSize - kBroad / 2, kBroad);
    return std::array{value_at(tile, x, y), clumps, 0.5F + value_at(tile, x, y) - around};
  });
}

Texture make_relief_texture() {
  constexpr std::size_t kStep = 9;  // 0.035 of the side
  return made_of_noise<3>(GL_RGB8, GL_RGB, [](const std::vector<float>& tile, std::size_t x, std::size_t y) {
    const float here = value_at(tile, x, y);
    return std::array{here, 0.5F + value_at(tile, x + kStep, y) - here, 0.5F + value_at(tile, x, y + kStep) - here};
  });
}

}  // namespace yuragi::viewer::gl
