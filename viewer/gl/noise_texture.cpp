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
  const auto lattice = [&](std::size_t x, std::size_t y) {
    return static_cast<float>(random.uniform((y % cells) * cells + x % cells));
  };
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

}  // namespace

GlTexture make_noise_texture() {
  std::vector<float> tile(kSize * kSize, 0.0F);
  float weight = 1.0F;
  for (const std::size_t cells : kCellsPerOctave) {
    add_octave(cells, weight, tile);
    weight *= 0.55F;
  }

  // Spread over the whole range.
  const auto [low, high] = std::minmax_element(tile.begin(), tile.end());
  const float from = *low;
  const float range = *high - *low;
  std::vector<std::uint8_t> texels(tile.size());
  std::transform(tile.begin(), tile.end(), texels.begin(),
                 [&](float value) { return static_cast<std::uint8_t>(255.0F * (value - from) / range); });

  return make_tile(GL_R8, GL_RED, kSize, texels);
}

}  // namespace yuragi::viewer::gl
