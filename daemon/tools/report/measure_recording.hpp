#pragma once

#include "daemon/tools/report/recording_survey.hpp"
#include "daemon/tools/report/report_numbers.hpp"
#include "daemon/tools/report/sensor_tally.hpp"
#include "drivers/windlog/windlog_reader.hpp"
#include "engine/base/result.hpp"

namespace yuragi::daemon::tools::report {

/// The largest number of sensors in a report.
inline constexpr std::size_t kMaxReportedSensors = 16;

/// Computes the numbers of a recording, which it reads twice. A recording without readings has none, and no sensors.
/// Fails as the reader does, and if a sensor of `settings.sensors` is missing or there are more than
/// kMaxReportedSensors. Memory does not grow with the length of the recording. Thread-safe: no. Realtime-safe: no.
Result<RecordingNumbers, Failure> measure_recording(drivers::windlog::Reader& reader, const Settings& settings,
                                                    const ReadingProgress& progress = {});

}  // namespace yuragi::daemon::tools::report
