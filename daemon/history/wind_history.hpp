#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <stop_token>
#include <string>
#include <vector>

#include "daemon/history/step.hpp"
#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi::daemon::history {

struct SensorHistory {
  std::string name;
  std::vector<Step> steps;  ///< WindHistory::step_count of them
};

/// The recorded wind of the last hours in steps of equal length.
struct WindHistory {
  std::int64_t begin_s = 0;  ///< of the first step, in s since 1970, UTC
  std::int64_t step_s = 0;
  std::size_t step_count = 0;
  std::vector<SensorHistory> sensors = {};  ///< in the order of their first readings
  std::size_t files_left_out = 0;           ///< files of the recording that are damaged or cannot be opened
};

/// More steps than these are not made, except for the one that has only begun.
inline constexpr std::int64_t kMaxSteps = 500;
/// Further sensors of a recording are left out.
inline constexpr std::size_t kMaxSensors = 16;
inline constexpr unsigned kMaxHistory_h = 366 * 24;

/// Returns true if a history of so many hours has steps that MeansFile can give, and is read from it.
bool is_of_means(unsigned hours);

/// Reads the `hours` (1 to kMaxHistory_h) before `now` from a recording or a series of them, also while it is
/// written. If is_of_means(), what was recorded since the last time is first added to the MeansFile beside it; the
/// first time this reads the whole recording, at about 3 million readings a second. Sensors of the same name in several
/// sessions are one. Fails as windlog::Reader does; `stop` ends it within milliseconds with a failure.
/// Thread-safe: for different recordings, and for one of means with one of readings. Realtime-safe: no; waits for the
/// disk.
Result<WindHistory, Failure> read_wind_history(const std::filesystem::path& file, UtcTime now, unsigned hours,
                                               const std::stop_token& stop = {});

}  // namespace yuragi::daemon::history
