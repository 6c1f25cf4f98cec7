#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "drivers/windlog/windlog_reader.hpp"
#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi::daemon::tools::report {

/// A part of a recording, in log time: from `from` on and before `to`.
struct LogRange {
  Nanoseconds from{0};
  Nanoseconds to{Nanoseconds::max()};
};

/// A silence of more than so many intervals ends a run of readings; shorter ones are bridged by a straight line.
inline constexpr double kBridgedIntervals = 3.0;

/// What must be known of a sensor before its numbers can be computed in one pass.
struct SensorSurvey {
  std::string name;
  std::string driver;
  double unchanged_for_s = 0.0;  ///< it sent only changes: a silence of up to this is not a gap; 0: it did not
  std::uint64_t readings = 0;
  std::uint64_t directed = 0;     ///< with a direction
  std::uint64_t gusts = 0;        ///< with a gust of the sensor's own
  double interval_s = 0.0;        ///< the median of the first 100 000; 0 for fewer than two readings
  double step_s = 0.0;            ///< the mean interval within runs; 0 if there is no run
  std::uint64_t longest_run = 0;  ///< samples of `step_s` in the longest run
};

struct RecordingSurvey {
  std::uint64_t readings = 0;
  std::uint64_t skipped = 0;
  Nanoseconds begin{0}, end{0};  ///< log time of the first and the last reading
  UtcTime first{}, last{};       ///< by its clock
  std::uint64_t clock_sets = 0;  ///< how often its clock was set by more than 2 s
  double largest_clock_set_s = 0.0;
  std::vector<SensorSurvey> sensors;   ///< by name, in the order of their first readings
  std::vector<std::size_t> sensor_of;  ///< index into `sensors` of each windlog::Reader::sensors()

  static constexpr std::size_t kNone = SIZE_MAX;  ///< in `sensor_of`: without readings
};

/// Called now and then with the readings so far.
using ReadingProgress = std::function<void(std::uint64_t readings)>;

/// Reads `range` once. Sensors of the same name in several sessions are one sensor. Fails as the reader does.
Result<RecordingSurvey, Failure> survey_recording(drivers::windlog::Reader& reader, const LogRange& range,
                                                  const ReadingProgress& progress);

/// Calls `use(reading)` for each reading of a range. Fails as the reader does.
Result<void, Failure> for_each_reading(drivers::windlog::Reader& reader, const LogRange& range,
                                       const std::function<void(const drivers::windlog::LoggedReading&)>& use);

}  // namespace yuragi::daemon::tools::report
