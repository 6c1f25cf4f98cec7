#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/result.hpp"

namespace yuragi::daemon::tools::plot {

/// How a curve is drawn.
enum class Style : std::uint8_t {
  kLine,
  kPoints,
  kSteps,
  kDots,  ///< small pale points, for large numbers of them
  kBand,  ///< the area between `y` and `y2`
  kBars,  ///< from 0 to `y`, touching each other
};

struct Curve {
  std::string title;  ///< empty: not in the legend
  Style style = Style::kLine;
  std::vector<double> x;
  std::vector<double> y;        ///< as many as `x`; a value that is not finite interrupts the line
  std::vector<double> y2 = {};  ///< of a band: as many as `x`
  std::string color = {};       ///< "#rrggbb"; empty: gnuplot's next default
};

/// A stretch of the x axis that is coloured behind the curves, over a part of the panel's height (0 bottom, 1 top).
struct Span {
  double from = 0.0;
  double to = 0.0;
  std::string color;  ///< "#rrggbb"
  double bottom = 0.0;
  double top = 1.0;
};

/// One pair of axes with its curves.
struct Panel {
  std::string title;
  std::string x_label;
  std::string y_label;
  bool is_x_log = false;
  bool is_y_log = false;
  std::vector<Curve> curves;
  bool is_x_time = false;  ///< x is seconds since 1970, written as dates and times of UTC
  std::optional<std::pair<double, double>> x_range = {};
  std::optional<std::pair<double, double>> y_range = {};
  double x_step = 0.0;  ///< between two tics of an x axis without times; 0: automatic
  double y_step = 0.0;  ///< between two tics of the y axis; 0: automatic; below 0: no tics
  std::vector<Span> spans = {};
  int height_px = 480;
};

/// The margins left and right of x axes with times, the same in all panels so that they line up.
inline constexpr int kTimeAxisLeft_px = 70;
inline constexpr int kTimeAxisRight_px = 24;

enum class Background : std::uint8_t { kWhite, kNone };

/// Draws the panels below one another into `file` (.png or .svg), which is replaced, with gnuplot. Fails if the name
/// has another extension, the file cannot be written, or gnuplot is not installed.
Result<void, Failure> draw_plot(const std::string& file, std::span<const Panel> panels, int width_px = 1000,
                                Background background = Background::kWhite);

}  // namespace yuragi::daemon::tools::plot
