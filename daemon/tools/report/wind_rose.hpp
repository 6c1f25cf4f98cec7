#pragma once

#include <array>
#include <string>
#include <string_view>

#include "daemon/tools/report/report_numbers.hpp"

namespace yuragi::daemon::tools::report {

/// Colours of the rose's speed classes, the weakest wind first.
inline constexpr std::array<std::string_view, kRoseClasses> kRoseColors = {"#a6cee3", "#6db1d8", "#3690c0",
                                                                           "#1f78b4", "#7b52ab", "#c51b8a"};

/// "2 to 4 m/s" and so on.
std::string rose_class_text(const WindRose& rose, std::size_t speed_class);

/// An SVG element: a wedge for each sector, in the direction that the wind came from, as long as its share of the
/// readings, in the colours of the speeds; each piece has a tooltip with its numbers. (gnuplot 5.4 has no wind rose.)
std::string draw_wind_rose(const WindRose& rose);

}  // namespace yuragi::daemon::tools::report
