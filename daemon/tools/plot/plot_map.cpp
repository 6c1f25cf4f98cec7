#include "daemon/tools/plot/plot_map.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "daemon/tools/plot/plot.hpp"
#include "daemon/tools/plot/plot_script.hpp"

namespace yuragi::daemon::tools::plot {
namespace {

constexpr int kMapWidth_px = 1000;
constexpr int kMapHeight_px = 880;

std::string map_script(const std::string& file, bool is_svg, const Map& map) {
  std::string script = plot_output(file, is_svg, kMapWidth_px, kMapHeight_px);
  const auto out = std::back_inserter(script);
  fmt::format_to(out, "set title {} noenhanced\nset xlabel {} noenhanced\nset ylabel {} noenhanced\n",
                 plot_text(map.title), plot_text(map.x_label), plot_text(map.y_label));
  // A palette of evenly increasing lightness, so that it is readable in grey.
  fmt::format_to(out,
                 "set cblabel {} noenhanced\nset palette defined (0 '#0b2c5f', 1 '#2f7f8f', 2 '#9fce8f', 3 '#fdf6c0')\n"
                 "set tics out nomirror\nset format '%g'\nset size ratio -1\n",
                 plot_text(map.value_label));
  // To the edges of the outermost samples, even if arrows reach further.
  const std::size_t rows = map.columns > 0 ? map.values.size() / map.columns : 0;
  const auto edges = [](double first, double step, std::size_t count) {
    const double from = first - 0.5 * step;
    const double to = from + step * static_cast<double>(count);
    return fmt::format("[{:.9g}:{:.9g}]", std::min(from, to), std::max(from, to));
  };
  fmt::format_to(out, "set xrange {}\nset yrange {}\n", edges(map.first_x, map.step_x, map.columns),
                 edges(map.first_y, map.step_y, rows));
  fmt::format_to(out, "plot '-' using 1:2:3 with image notitle{}\n",
                 map.arrows.empty()
                     ? ""
                     : ", '-' using 1:2:3:4 with vectors head size screen 0.007,20 filled linewidth 1.1 linecolor rgb "
                       "'#202020' notitle");

  // The numbers follow the plot command, the image's first.
  for (std::size_t i = 0; i < map.values.size(); ++i) {
    const double x = map.first_x + map.step_x * static_cast<double>(i % map.columns);
    const double y = map.first_y + map.step_y * static_cast<double>(i / map.columns);
    if (std::isfinite(map.values[i])) {
      fmt::format_to(out, "{:.9g} {:.9g} {:.6g}\n", x, y, map.values[i]);
    } else {
      fmt::format_to(out, "{:.9g} {:.9g} NaN\n", x, y);
    }
  }
  fmt::format_to(out, "e\n");
  for (const Arrow& arrow : map.arrows) {
    fmt::format_to(out, "{:.9g} {:.9g} {:.6g} {:.6g}\n", arrow.x, arrow.y, arrow.dx, arrow.dy);
  }
  if (!map.arrows.empty()) fmt::format_to(out, "e\n");
  script += "unset output\n";
  return script;
}

}  // namespace

Result<void, Failure> draw_map(const std::string& file, const Map& map) {
  return draw_script(file,
                     [&](const std::string& unfinished, bool is_svg) { return map_script(unfinished, is_svg, map); });
}

}  // namespace yuragi::daemon::tools::plot
