#include "daemon/tools/plot/plot_script.hpp"

#include <array>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <system_error>

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace yuragi {
namespace {

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

std::string plot_text(std::string_view text) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'') result += '\'';
    result += c == '\n' || c == '\r' ? ' ' : c;
  }
  return result + "'";
}

std::string plot_output(const std::string& file, bool is_svg, int width_px, int height_px) {
  return fmt::format("set encoding utf8\nset terminal {} size {},{} {}\nset output {}\n", is_svg ? "svg" : "pngcairo",
                     width_px, height_px, is_svg ? "dynamic background 'white'" : "background 'white'",
                     plot_text(file));
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

  // The picture takes its name when it is whole.
  const std::string unfinished = file + ".part";
  const std::string script_file = file + ".gnuplot";
  std::ofstream(script_file, std::ios::binary) << script_of(unfinished, file.ends_with(".svg"));
  const bool was_drawn = run_gnuplot(script_file);
  std::error_code error;
  std::filesystem::remove(script_file, error);
  if (was_drawn) {
    std::filesystem::rename(unfinished, file, error);
    if (!error) return {};
  }
  std::filesystem::remove(unfinished, error);
  return Failure{file +
                     ": the plot could not be drawn: does its folder exist, may you write to it, is there room, and "
                     "is gnuplot installed (apt-get install gnuplot-nox)?",
                 FailureKind::kCannotCreate};
}

}  // namespace yuragi
