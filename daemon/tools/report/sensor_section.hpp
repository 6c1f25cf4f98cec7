#pragma once

#include <string>

#include "daemon/tools/report/page_writer.hpp"
#include "daemon/tools/report/report_figures.hpp"
#include "daemon/tools/report/report_numbers.hpp"

namespace yuragi {

/// One sentence, as HTML: how the wind was, and whether the sensor was heard.
std::string sentence_of(const RecordingNumbers& recording, const SensorNumbers& sensor);

/// Everything about one sensor: figures, tables, states and gaps. `is_first`: no new sheet of paper begins before it.
void add_sensor_section(PageWriter& page, const RecordingNumbers& recording, const SensorNumbers& sensor,
                        const SensorFigures& figures, bool is_first);

}  // namespace yuragi
