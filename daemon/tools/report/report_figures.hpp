#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>

#include "daemon/tools/report/report_numbers.hpp"
#include "engine/base/result.hpp"

namespace yuragi {

/// Colours of the states, in the figures and in their legend; live has none.
inline constexpr std::array<std::string_view, kRecordedStates> kRecordedStateColors = {"#3fa66b", "#9a9a9a", "#e0a100",
                                                                                       "#d9662b", "#3d7edb", "#c2453d"};

/// The figures of one sensor, each an SVG element for a page; empty where there is nothing to draw.
struct SensorFigures {
  std::string series;  ///< speed, gust, direction and state over time
  std::string rose;
  std::string distribution;
  std::string spectrum;
  std::string diurnal;
};

/// Draws them, by gnuplot but for the rose. `scratch`: a file name that is free, in a folder that can be written to.
/// `index`: the sensor's number on the page; it makes the ids of its SVG elements different from the others'.
/// Fails where gnuplot is not installed or cannot draw. Realtime-safe: no.
Result<SensorFigures, Failure> draw_figures(const RecordingNumbers& recording, const SensorNumbers& sensor,
                                            const std::filesystem::path& scratch, std::size_t index);

/// gnuplot's SVG file as an element of a page: with no prolog and no background, under ids that begin with `prefix`.
/// Fails where it looks like no SVG of gnuplot's.
Result<std::string, Failure> embedded_svg(const std::string& file, const std::string& prefix, std::string_view label);

}  // namespace yuragi
