#include "daemon/values/grid.hpp"

#include <cmath>
#include <numbers>

namespace yuragi::daemon::values {

Grid::Point Grid::at(std::size_t index) const noexcept {
  const auto from_middle_m = [this](std::size_t place, std::size_t count) {
    return (static_cast<double>(place) - 0.5 * static_cast<double>(count - 1)) * spacing_m;
  };
  const double right_m = from_middle_m(index % columns, columns);
  const double down_m = from_middle_m(index / columns, rows);
  const double turn = turn_deg * std::numbers::pi / 180.0;
  return {.east_m = east_m + right_m * std::cos(turn) - down_m * std::sin(turn),
          .south_m = south_m + right_m * std::sin(turn) + down_m * std::cos(turn)};
}

}  // namespace yuragi::daemon::values
