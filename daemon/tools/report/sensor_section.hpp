#pragma once

#include <string>

#include "daemon/tools/report/page_writer.hpp"
#include "daemon/tools/report/report_figures.hpp"
#include "daemon/tools/report/report_numbers.hpp"

namespace yuragi::daemon::tools::report {

/// One sentence, as HTML: the wind, and how long the sensor was live.
std::string sentence_of(const RecordingNumbers& recording, const SensorNumbers& sensor);

/// Everything about one sensor: figures, tables, states and gaps. `is_first`: no page break before it.
void add_sensor_section(PageWriter& page, const RecordingNumbers& recording, const SensorNumbers& sensor,
                        const SensorFigures& figures, bool is_first);

}  // namespace yuragi::daemon::tools::report
