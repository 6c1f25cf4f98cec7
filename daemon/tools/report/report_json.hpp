#pragma once

#include <string>

#include "daemon/tools/report/report_numbers.hpp"

namespace yuragi::daemon::tools::report {

/// The report's numbers for machines: JSON, with the unit in each key, null if something is not known, times in
/// seconds of log time and in UTC (ISO 8601). `source`: the recording's name. Invalid UTF-8 in names is replaced.
std::string report_json(const RecordingNumbers& recording, const std::string& source);

}  // namespace yuragi::daemon::tools::report
