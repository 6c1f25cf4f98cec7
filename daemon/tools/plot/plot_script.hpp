#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "engine/base/result.hpp"

namespace yuragi::daemon::tools::plot {

// Shared by all plots that gnuplot draws: plot.cpp (curves), plot_map.cpp (a map).

/// Fails unless a plot can be drawn into a file of this name; for checking that before hours of work.
Result<void, Failure> check_plot_name(const std::string& file);

/// Text quoted for gnuplot: in single quotes, with quotes doubled. Line ends become spaces.
std::string plot_text(std::string_view text);

/// The lines of a script that set the output file, the size, and the background: white or transparent.
std::string plot_output(const std::string& file, bool is_svg, int width_px, int height_px, bool has_background = true);

/// Draws into a temporary file by the script that `script_of` makes for its name, and renames that to `file`. Fails as
/// draw_plot().
Result<void, Failure> draw_script(
    const std::string& file, const std::function<std::string(const std::string& unfinished, bool is_svg)>& script_of);

}  // namespace yuragi::daemon::tools::plot
