#include "viewer/gl/ripple_texture.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "engine/math/philox.hpp"

namespace yuragi::viewer::gl {
namespace {

constexpr std::size_t kRippleTexels = 128;
constexpr std::size_t kRippleWaves = 48;
constexpr double kLongest = 4.0;    // cycles a tile
constexpr double kShortest = 20.0;  // finer ones would show the texels

}  // namespace

Texture make_ripple_texture() {
  // A sum of plane waves in all directions, all of the same steepness.
  const math::RandomStream random(0, math::stream_id("viewer ripples"));
  std::vector<double> slopes(2 * kRippleTexels * kRippleTexels, 0.0);
  const double wave_slope = 2.0 * static_cast<double>(kRippleDeviation) / std::sqrt(static_cast<double>(kRippleWaves));
  for (std::size_t wave = 0; wave < kRippleWaves; ++wave) {
    const auto [way, length] = random.uniform_pair(2 * wave);
    const double phase = 2.0 * std::numbers::pi * random.uniform_pair(2 * wave + 1)[0];
    const double cycles = kLongest * std::pow(kShortest / kLongest, length);
    const double east = std::round(cycles * std::cos(2.0 * std::numbers::pi * way));
    const double south = std::round(cycles * std::sin(2.0 * std::numbers::pi * way));
    const double whole = std::max(std::hypot(east, south), 1.0);
    for (std::size_t i = 0; i < kRippleTexels * kRippleTexels; ++i) {
      const std::size_t column = i % kRippleTexels;
      const std::size_t row = i / kRippleTexels;
      const double turn =
          (east * static_cast<double>(column) + south * static_cast<double>(row)) / static_cast<double>(kRippleTexels);
      const double slope = wave_slope * std::cos(2.0 * std::numbers::pi * turn + phase);
      slopes[2 * i] += slope * east / whole;
      slopes[2 * i + 1] += slope * south / whole;
    }
  }
  std::vector<std::uint8_t> texels(slopes.size());
  std::transform(slopes.begin(), slopes.end(), texels.begin(), [](double slope) {
    return static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(0.5 + slope, 0.0, 1.0)));
  });

  return make_tile(GL_RG8, GL_RG, static_cast<GLsizei>(kRippleTexels), texels);
}

}  // namespace yuragi::viewer::gl
