#include "daemon/tools/plot/plot.hpp"

#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "daemon/tools/plot/plot_script.hpp"

namespace yuragi::daemon::tools::plot {
namespace {

std::string_view style_of(Style style) {
  switch (style) {
    case Style::kLine:
      return "lines linewidth 1.6";
    case Style::kPoints:
      return "points pointtype 7 pointsize 0.8";
    case Style::kSteps:
      return "steps linewidth 1.4";
    case Style::kDots:
      return "points pointtype 7 pointsize 0.25";
    case Style::kBand:
      return "filledcurves fillstyle transparent solid 0.3 noborder";
    case Style::kBars:
      return "boxes fillstyle transparent solid 0.55 noborder";
  }
  return "lines";
}

/// The distance and format of the tics of a time axis, so that there are about seven.
struct TimeMarks {
  double step_s;
  std::string_view format;
};

TimeMarks time_marks(double span_s) {
  constexpr double kHour_s = 3600.0;
  constexpr double kDay_s = 86400.0;
  constexpr std::string_view kSeconds = "%H:%M:%S";
  constexpr std::string_view kMinutes = "%H:%M";
  constexpr std::string_view kHours = "%H:%M\\n%d %b";
  constexpr std::string_view kDates = "%d %b\\n%Y";
  constexpr std::array kMarks = {
      TimeMarks{1, kSeconds},         TimeMarks{2, kSeconds},          TimeMarks{5, kSeconds},
      TimeMarks{10, kSeconds},        TimeMarks{30, kSeconds},         TimeMarks{60, kMinutes},
      TimeMarks{120, kMinutes},       TimeMarks{300, kMinutes},        TimeMarks{600, kMinutes},
      TimeMarks{1800, kMinutes},      TimeMarks{kHour_s, kHours},      TimeMarks{2 * kHour_s, kHours},
      TimeMarks{4 * kHour_s, kHours}, TimeMarks{6 * kHour_s, kHours},  TimeMarks{12 * kHour_s, kHours},
      TimeMarks{kDay_s, kDates},      TimeMarks{2 * kDay_s, kDates},   TimeMarks{4 * kDay_s, kDates},
      TimeMarks{7 * kDay_s, kDates},  TimeMarks{14 * kDay_s, kDates},  TimeMarks{28 * kDay_s, kDates},
      TimeMarks{91 * kDay_s, kDates}, TimeMarks{182 * kDay_s, kDates}, TimeMarks{365 * kDay_s, kDates}};
  constexpr double kMaxMarks = 8.0;
  for (const TimeMarks& marks : kMarks) {
    if (span_s <= kMaxMarks * marks.step_s) return marks;
  }
  return {std::ceil(span_s / kMaxMarks / (365.0 * kDay_s)) * 365.0 * kDay_s, kDates};
}

/// The settings before the plot command of a panel. All are set, so that none is left of the panel before.
void add_axes(std::string& script, const Panel& panel, int width_px) {
  const auto out = std::back_inserter(script);
  fmt::format_to(out, "set title {} noenhanced\nset xlabel {} noenhanced\nset ylabel {} noenhanced\n",
                 plot_text(panel.title), plot_text(panel.x_label), plot_text(panel.y_label));
  fmt::format_to(out, "unset logscale\n{}{}", panel.is_x_log ? "set logscale x\n" : "",
                 panel.is_y_log ? "set logscale y\n" : "");
  const auto add_range = [&](std::string_view axis, const std::optional<std::pair<double, double>>& range) {
    if (range) {
      fmt::format_to(out, "set {}range [{:.15g}:{:.15g}]\n", axis, range->first, range->second);
    } else {
      fmt::format_to(out, "set {}range [*:*]\n", axis);
    }
  };
  add_range("x", panel.x_range);
  add_range("y", panel.y_range);

  // Time axes line up between panels, with the same tics.
  if (panel.is_x_time && panel.x_range) {
    const TimeMarks marks = time_marks(panel.x_range->second - panel.x_range->first);
    fmt::format_to(out, "set format x \"{}\" time\nset xtics {:g}\n", marks.format, marks.step_s);
    fmt::format_to(out, "set lmargin at screen {:.6f}\nset rmargin at screen {:.6f}\n",
                   static_cast<double>(kTimeAxisLeft_px) / width_px,
                   1.0 - static_cast<double>(kTimeAxisRight_px) / width_px);
  } else {
    fmt::format_to(out, "set format x '%g' numeric\nset xtics {}\nset lmargin\nset rmargin\n",
                   panel.x_step > 0.0 ? fmt::format("{:g}", panel.x_step) : "autofreq");
  }
  if (panel.y_step > 0.0) {
    fmt::format_to(out, "set ytics {:g}\n", panel.y_step);
  } else {
    fmt::format_to(out, "{}", panel.y_step < 0.0 ? "unset ytics\n" : "set ytics autofreq\n");
  }

  fmt::format_to(out, "unset object\n");
  for (const Span& span : panel.spans) {
    fmt::format_to(out,
                   "set object rectangle from first {:.15g}, graph {:g} to first {:.15g}, graph {:g} behind fillcolor "
                   "rgb '{}' fillstyle solid 1 noborder\n",
                   span.from, span.bottom, span.to, span.top, span.color);
  }
}

std::string script_of(const std::string& file, bool is_svg, std::span<const Panel> panels, int width_px,
                      Background background) {
  std::string script;
  const auto out = std::back_inserter(script);
  int height_px = 0;
  for (const Panel& panel : panels) height_px += panel.height_px;
  script += plot_output(file, is_svg, width_px, height_px, background == Background::kWhite);
  fmt::format_to(out, "set multiplot\n");
  fmt::format_to(out,
                 "set grid xtics ytics back linetype 1 linewidth 0.5 linecolor rgb '#cccccc'\nset key top right "
                 "noenhanced\nset tics nomirror\nset format '%g'\nset boxwidth 1 relative\n");
  int below_px = height_px;
  for (const Panel& panel : panels) {
    below_px -= panel.height_px;
    fmt::format_to(out, "set size 1,{:.6f}\nset origin 0,{:.6f}\n", static_cast<double>(panel.height_px) / height_px,
                   static_cast<double>(below_px) / height_px);
    add_axes(script, panel, width_px);

    // The numbers follow the plot command, one block per curve.
    std::string commands;
    std::string data;
    for (const Curve& curve : panel.curves) {
      const bool is_band = curve.style == Style::kBand;
      commands +=
          fmt::format("{}'-' using {} with {} {} {}", commands.empty() ? "plot " : ", ", is_band ? "1:2:3" : "1:2",
                      style_of(curve.style), curve.color.empty() ? "" : "linecolor rgb " + plot_text(curve.color),
                      curve.title.empty() ? "notitle" : "title " + plot_text(curve.title) + " noenhanced");
      for (std::size_t i = 0; i < curve.x.size(); ++i) {
        const double y2 = is_band ? curve.y2[i] : 0.0;
        const bool is_drawn = std::isfinite(curve.x[i]) && std::isfinite(curve.y[i]) && std::isfinite(y2);
        data += is_drawn ? fmt::format("{:.15g} {:.9g} {:.9g}\n", curve.x[i], curve.y[i], y2) : "\n";
      }
      data += "e\n";
    }
    if (commands.empty() && !panel.spans.empty()) commands = "plot NaN notitle";
    if (commands.empty()) continue;
    script += commands;
    script += '\n';
    script += data;
  }
  script += "unset multiplot\nunset output\n";
  return script;
}

}  // namespace

Result<void, Failure> draw_plot(const std::string& file, std::span<const Panel> panels, int width_px,
                                Background background) {
  return draw_script(file, [&](const std::string& unfinished, bool is_svg) {
    return script_of(unfinished, is_svg, panels, width_px, background);
  });
}

}  // namespace yuragi::daemon::tools::plot
