#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "engine/base/result.hpp"

namespace yuragi {

// What all pictures share that gnuplot draws: plot.cpp (curves), plot_map.cpp (a map).

/// Fails unless a plot can be drawn into a file of this name: to be asked before hours of work.
Result<void, Failure> check_plot_name(const std::string& file);

/// Text as gnuplot takes it: in single quotes, in which a quote stands twice. Line ends, which would end the command,
/// become spaces.
std::string plot_text(std::string_view text);

/// The lines of a script that say where the picture goes, how large it is, and whether it is white where nothing
/// is drawn or has nothing there.
std::string plot_output(const std::string& file, bool is_svg, int width_px, int height_px, bool has_background = true);

/// Draws into `file` by the script that `script_of` makes for a picture of that name; the picture takes the name of
/// `file` when it is whole. Fails as draw_plot().
Result<void, Failure> draw_script(
    const std::string& file, const std::function<std::string(const std::string& unfinished, bool is_svg)>& script_of);

}  // namespace yuragi
