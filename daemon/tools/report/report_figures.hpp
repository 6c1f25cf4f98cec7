#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>

#include "daemon/tools/report/report_numbers.hpp"
#include "engine/base/result.hpp"

namespace yuragi::daemon::tools::report {

/// Colours of the states, in the figures and in their legend; live has none.
inline constexpr std::array<std::string_view, kRecordedStates> kRecordedStateColors = {"#3fa66b", "#9a9a9a", "#e0a100",
                                                                                       "#d9662b", "#3d7edb", "#c2453d"};

/// The figures of one sensor, each an SVG element for a page; empty if there is nothing to draw.
struct SensorFigures {
  std::string series;  ///< speed, gust, direction and state over time
  std::string rose;
  std::string distribution;
  std::string spectrum;
  std::string diurnal;
};

/// Draws them with gnuplot, except the rose. `scratch`: an unused file name in a writable folder.
/// Fails if gnuplot is not installed or cannot draw. Realtime-safe: no.
Result<SensorFigures, Failure> draw_figures(const RecordingNumbers& recording, const SensorNumbers& sensor,
                                            const std::filesystem::path& scratch);

/// An SVG element that embeds a whole SVG file as an image, so that its ids and styles do not collide with the page's.
/// `over`: SVG elements that are drawn over it.
std::string embedded_plot(std::string_view svg, int width_px, int height_px, std::string_view label,
                          std::string_view over = {});

}  // namespace yuragi::daemon::tools::report
