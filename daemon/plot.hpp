#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace yuragi {

/// How a curve is drawn.
enum class PlotStyle : std::uint8_t { kLine, kPoints, kSteps };

struct PlotCurve {
  std::string title;  ///< empty: not in the legend
  PlotStyle style = PlotStyle::kLine;
  std::vector<double> x;
  std::vector<double> y;  ///< as many as `x`; what is not finite is left out
};

/// One pair of axes with its curves.
struct PlotPanel {
  std::string title;
  std::string x_label;
  std::string y_label;
  bool is_x_log = false;
  bool is_y_log = false;
  std::vector<PlotCurve> curves;
};

/// Draws the panels below one another into `file`, whose name ends in .png or .svg; one of that name is replaced. By
/// gnuplot. Throws ExitError where the name is another one, the file cannot be written, or gnuplot is not installed.
void draw_plot(const std::string& file, std::span<const PlotPanel> panels);

/// Throws ExitError unless draw_plot() could draw into a file of this name: to be asked before hours of work.
void check_plot_name(const std::string& file);

}  // namespace yuragi
