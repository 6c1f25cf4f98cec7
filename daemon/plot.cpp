#include "daemon/plot.hpp"

#include <cmath>
#include <iterator>
#include <string_view>

#include <fmt/format.h>

#include "daemon/exit.hpp"
#include "daemon/plot_script.hpp"

namespace yuragi {
namespace {

constexpr int kWidth_px = 1000;
constexpr int kPanelHeight_px = 480;

std::string_view style_of(PlotStyle style) {
  switch (style) {
    case PlotStyle::kLine:
      return "lines linewidth 1.6";
    case PlotStyle::kPoints:
      return "points pointtype 7 pointsize 0.8";
    case PlotStyle::kSteps:
      return "steps linewidth 1.4";
  }
  return "lines";
}

std::string script_of(const std::string& file, bool is_svg, std::span<const PlotPanel> panels) {
  std::string script;
  const auto out = std::back_inserter(script);
  script += plot_output(file, is_svg, kWidth_px, kPanelHeight_px * static_cast<int>(panels.size()));
  fmt::format_to(out, "set multiplot layout {},1\n", panels.size());
  fmt::format_to(out,
                 "set grid xtics ytics back linetype 1 linewidth 0.5 linecolor rgb '#cccccc'\nset key top right "
                 "noenhanced\nset tics nomirror\nset format '%g'\n");
  for (const PlotPanel& panel : panels) {
    fmt::format_to(out, "set title {} noenhanced\nset xlabel {} noenhanced\nset ylabel {} noenhanced\n",
                   plot_text(panel.title), plot_text(panel.x_label), plot_text(panel.y_label));
    fmt::format_to(out, "unset logscale\n{}{}", panel.is_x_log ? "set logscale x\n" : "",
                   panel.is_y_log ? "set logscale y\n" : "");

    // The numbers follow the plot command, one block a curve.
    std::string commands;
    std::string data;
    for (const PlotCurve& curve : panel.curves) {
      commands += fmt::format("{}'-' with {} {}", commands.empty() ? "plot " : ", ", style_of(curve.style),
                              curve.title.empty() ? "notitle" : "title " + plot_text(curve.title));
      for (std::size_t i = 0; i < curve.x.size(); ++i) {
        const bool is_drawn = std::isfinite(curve.x[i]) && std::isfinite(curve.y[i]);
        data += is_drawn ? fmt::format("{:.9g} {:.9g}\n", curve.x[i], curve.y[i]) : "\n";
      }
      data += "e\n";
    }
    if (commands.empty()) continue;
    script += commands;
    script += '\n';
    script += data;
  }
  script += "unset multiplot\nunset output\n";
  return script;
}

}  // namespace

void check_plot_name(const std::string& file) {
  if (!file.ends_with(".png") && !file.ends_with(".svg")) {
    throw ExitError(kExitUsage, file + ": a plot is a .png or a .svg; name it so");
  }
}

void draw_plot(const std::string& file, std::span<const PlotPanel> panels) {
  draw_script(file, [&](const std::string& unfinished, bool is_svg) { return script_of(unfinished, is_svg, panels); });
}

}  // namespace yuragi
