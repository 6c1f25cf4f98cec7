#pragma once

#include <cstddef>

#include "daemon/values/quantity.hpp"

namespace yuragi::daemon::values {

/// Points on the ground in rows and columns, and which value of their wind is sent. The first is the one in the north
/// west, if the grid is not turned; the points of a row follow each other from west to east, then the next row south.
struct Grid {
  std::size_t columns = 1, rows = 1;
  double spacing_m = 1.0;
  double east_m = 0.0, south_m = 0.0;  ///< of its middle, from the middle of the scenes
  double turn_deg = 0.0;               ///< clockwise, seen from above
  Quantity quantity = Quantity::kSpeed;
  friend bool operator==(const Grid&, const Grid&) = default;

  struct Point {
    double east_m, south_m;
  };
  std::size_t size() const noexcept { return columns * rows; }
  Point at(std::size_t index) const noexcept;
};

}  // namespace yuragi::daemon::values
