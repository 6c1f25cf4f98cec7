#include "engine/noise/unit_reading.hpp"

#include <cmath>
#include <cstddef>
#include <span>

namespace yuragi::noise {

void scale_to_unit_reading(Tile2& tile) {
  double own = 0.0;
  double beside = 0.0;
  double across = 0.0;
  const std::size_t last = tile.size - 1;
  for (std::size_t z = 0; z < tile.size; ++z) {
    const std::span here = std::span(tile.values).subspan(z * tile.size, tile.size);
    const std::span next = std::span(tile.values).subspan(((z + 1) & last) * tile.size, tile.size);
    for (std::size_t x = 0; x < tile.size; ++x) {
      const std::size_t east = (x + 1) & last;
      own += static_cast<double>(here[x] * here[x]);
      beside += static_cast<double>(here[x] * (here[east] + next[x]));
      across += static_cast<double>(here[x] * next[east] + here[east] * next[x]);
    }
  }
  const double variance = (4.0 * own + 2.0 * beside + across / 2.0) / 9.0 / static_cast<double>(tile.values.size());
  const auto scale = static_cast<float>(1.0 / std::sqrt(variance));
  for (float& value : tile.values) value *= scale;
}

void scale_to_unit_reading(Tile1& tile) {
  double squares = 0.0;
  for (std::size_t i = 0; i < tile.size(); ++i) {
    const auto here = static_cast<double>(tile.values[i]);
    squares += here * (2.0 * here + static_cast<double>(tile.values[(i + 1) % tile.size()])) / 3.0;
  }
  const auto scale = static_cast<float>(1.0 / std::sqrt(squares / static_cast<double>(tile.size())));
  for (float& value : tile.values) value *= scale;
}

}  // namespace yuragi::noise
