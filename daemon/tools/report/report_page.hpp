#pragma once

#include <span>
#include <string>

#include "daemon/tools/report/report_figures.hpp"
#include "daemon/tools/report/report_numbers.hpp"

namespace yuragi::daemon::tools::report {

/// The whole page: one self-contained HTML file without scripts. `source`: the recording's name. `figures`: one
/// for each of the recording's sensors. All text from outside is escaped (page_text).
std::string report_page(const RecordingNumbers& recording, std::span<const SensorFigures> figures,
                        const std::string& source);

}  // namespace yuragi::daemon::tools::report
