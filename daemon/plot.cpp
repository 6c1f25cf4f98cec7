#include "daemon/plot.hpp"

#include <array>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "daemon/exit.hpp"

namespace yuragi {
namespace {

constexpr int kWidth_px = 1000;
constexpr int kPanelHeight_px = 480;

/// Text as gnuplot takes it: in single quotes, in which a quote stands twice. Line ends would end the command.
std::string plot_text(std::string_view text) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'') result += '\'';
    result += c == '\n' || c == '\r' ? ' ' : c;
  }
  return result + "'";
}

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
  fmt::format_to(out, "set terminal {} size {},{} {}\n", is_svg ? "svg" : "pngcairo", kWidth_px,
                 kPanelHeight_px * panels.size(), is_svg ? "dynamic background 'white'" : "background 'white'");
  fmt::format_to(out, "set output {}\nset multiplot layout {},1\n", plot_text(file), panels.size());
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

/// Runs gnuplot on a script. False: it is not installed, or not content.
bool run_gnuplot(const std::string& script_file) {
  std::string program = "gnuplot";
  std::string argument = script_file;
  std::array<char*, 3> arguments = {program.data(), argument.data(), nullptr};
  pid_t child = 0;
  if (posix_spawnp(&child, program.c_str(), nullptr, nullptr, arguments.data(), environ) != 0) return false;
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) return false;
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace

void check_plot_name(const std::string& file) {
  if (!file.ends_with(".png") && !file.ends_with(".svg")) {
    throw ExitError(kExitUsage, file + ": a plot is a .png or a .svg; name it so");
  }
}

void draw_plot(const std::string& file, std::span<const PlotPanel> panels) {
  check_plot_name(file);

  // The picture takes its name when it is whole.
  const std::string unfinished = file + ".part";
  const std::string script_file = file + ".gnuplot";
  std::ofstream(script_file, std::ios::binary) << script_of(unfinished, file.ends_with(".svg"), panels);
  const bool was_drawn = run_gnuplot(script_file);
  std::error_code error;
  std::filesystem::remove(script_file, error);
  if (was_drawn) {
    std::filesystem::rename(unfinished, file, error);
    if (!error) return;
  }
  std::filesystem::remove(unfinished, error);
  throw ExitError(kExitCannotCreate,
                  file +
                      ": the plot could not be drawn: is its folder there, may you write to it, is there room, and is "
                      "gnuplot installed (apt-get install gnuplot-nox)?");
}

}  // namespace yuragi
