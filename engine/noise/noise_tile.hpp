#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace yuragi::noise {

/// A periodic noise on a line: size() samples, the last followed by the first. Mean 0, variance 1 (to rounding).
/// Values are multiples of 2^-20, so that they are the same on every machine.
struct Tile1 {
  std::vector<float> values;

  std::size_t size() const { return values.size(); }
};

/// A periodic noise on a square torus: size x size samples, stored in rows (along x), one after the other (along z).
struct Tile2 {
  std::size_t size = 0;
  std::vector<float> values;

  float at(std::size_t x, std::size_t z) const { return values[z * size + x]; }
};

/// A periodic noise in a cube: `size` level squares, each laid out as a Tile2, one above the other (along y).
struct Tile3 {
  std::size_t size = 0;
  std::vector<float> values;

  float at(std::size_t x, std::size_t y, std::size_t z) const { return values[(y * size + z) * size + x]; }
};

}  // namespace yuragi::noise
