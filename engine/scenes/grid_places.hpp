#pragma once

#include <cstddef>
#include <span>

namespace yuragi::scenes {

/// Are these places (of x and z) the rows of a grid, `columns` in each, that go along x and all have the same x? Then
/// GridSampleJob can read them. 0 columns: no grid. Thread-safe and realtime-safe: yes.
inline bool goes_along_axes(std::span<const float> x_m, std::span<const float> z_m, std::size_t columns) noexcept {
  if (columns == 0 || x_m.empty() || x_m.size() % columns != 0) return false;
  for (std::size_t i = 0; i < x_m.size(); ++i) {
    if (x_m[i] != x_m[i % columns] || z_m[i] != z_m[i / columns * columns]) return false;
  }
  return true;
}

}  // namespace yuragi::scenes
