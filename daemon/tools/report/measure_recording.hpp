#pragma once

#include "daemon/tools/report/recording_survey.hpp"
#include "daemon/tools/report/report_numbers.hpp"
#include "daemon/tools/report/sensor_tally.hpp"
#include "drivers/windlog/windlog_reader.hpp"
#include "engine/base/result.hpp"

namespace yuragi {

/// A page of more sensors than this is no page.
inline constexpr std::size_t kMaxReportedSensors = 16;

/// Reads a recording twice and takes its numbers. A recording without readings has none, and no sensors. Fails as the
/// reader does, and where a sensor of `settings.sensors` is not there or there are more than kMaxReportedSensors.
/// Memory does not grow with the length of the recording. Thread-safe: no. Realtime-safe: no.
Result<RecordingNumbers, Failure> measure_recording(WindlogReader& reader, const ReportSettings& settings,
                                                    const ReadingProgress& progress = {});

}  // namespace yuragi
