#include "daemon/tools/plot/plot_script.hpp"

#include <fstream>
#include <system_error>

#include <fmt/format.h>

#include "engine/platform/child_process.hpp"
#include "engine/platform/whole_file.hpp"

namespace yuragi::daemon::tools::plot {
namespace {

/// Runs gnuplot on a script. Returns false if it is not installed, or failed.
bool run_gnuplot(const std::string& script_file) {
  try {
    return platform::ChildProcess({.command = {"gnuplot", script_file}}).wait().is_good();
  } catch (const std::system_error&) {
    return false;
  }
}

}  // namespace

std::string plot_text(std::string_view text) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'') result += '\'';
    result += c == '\n' || c == '\r' ? ' ' : c;
  }
  return result + "'";
}

std::string plot_output(const std::string& file, bool is_svg, int width_px, int height_px, bool has_background) {
  return fmt::format("set encoding utf8\nset terminal {} size {},{} {}\nset output {}\n",
                     is_svg ? "svg dynamic font 'sans-serif,12'" : "pngcairo", width_px, height_px,
                     has_background ? "background 'white'" : "", plot_text(file));
}

Result<void, Failure> check_plot_name(const std::string& file) {
  if (!file.ends_with(".png") && !file.ends_with(".svg")) {
    return Failure{file + ": a plot is written as .png or .svg; choose such a file name", FailureKind::kUsage};
  }
  return {};
}

Result<void, Failure> draw_script(
    const std::string& file, const std::function<std::string(const std::string& unfinished, bool is_svg)>& script_of) {
  if (auto named = check_plot_name(file); !named) return named;

  // The script is an OutputFile without a commit(), so it is removed.
  platform::OutputFile picture(file, true);
  const platform::OutputFile script(file + ".gnuplot", true);
  std::ofstream(script.working_path(), std::ios::binary) << script_of(picture.working_path(), file.ends_with(".svg"));
  if (run_gnuplot(script.working_path())) return picture.commit();
  return Failure{file +
                     ": the plot could not be drawn: does its folder exist, may you write to it, is there room, and "
                     "is gnuplot installed (apt-get install gnuplot-nox)?",
                 FailureKind::kCannotCreate};
}

}  // namespace yuragi::daemon::tools::plot
