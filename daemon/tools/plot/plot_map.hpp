#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "engine/base/result.hpp"

namespace yuragi::daemon::tools::plot {

/// An arrow from a place on a map, in the units of its axes.
struct Arrow {
  double x = 0.0, y = 0.0;
  double dx = 0.0, dy = 0.0;
};

/// A quantity over a plane, as colours, with arrows upon it.
struct Map {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::string value_label;
  std::size_t columns = 0;  ///< samples along x
  double first_x = 0.0, step_x = 1.0;
  double first_y = 0.0, step_y = 1.0;  ///< a step may be below 0
  std::vector<double> values;  ///< rows of `columns` each, from first_y on; values that are not finite are not drawn
  std::vector<Arrow> arrows;
};

/// Draws it into `file`, to scale, as draw_plot() draws curves. Fails as that does.
Result<void, Failure> draw_map(const std::string& file, const Map& map);

}  // namespace yuragi::daemon::tools::plot
