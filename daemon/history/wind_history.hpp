#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <stop_token>
#include <string>
#include <vector>

#include "engine/base/result.hpp"
#include "engine/base/time.hpp"
#include "engine/wind/wind_vector.hpp"

namespace yuragi::daemon::history {

/// What a sensor reported in one step of time, before calibration.
struct Step {
  std::uint64_t readings = 0;  ///< 0: a gap, in which nothing else is known
  double sum_m_s = 0.0, min_m_s = 0.0, max_m_s = 0.0;
  wind::Vector vector_sum_m_s = {};  ///< of the readings with a direction

  double mean_m_s() const { return sum_m_s / static_cast<double>(readings); }
};

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
};

/// More steps than these are not made, except for the one that has only begun.
inline constexpr std::int64_t kMaxSteps = 500;
/// Further sensors of a recording are left out.
inline constexpr std::size_t kMaxSensors = 16;
inline constexpr unsigned kMaxHistory_h = 168;

/// Reads the `hours` (1 to kMaxHistory_h) before `now` from a recording or a series of them, also while it is
/// written. Sensors of the same name in several sessions are one. Fails as windlog::Reader does; `stop` ends it within
/// milliseconds with a failure. Thread-safe: yes. Realtime-safe: no; waits for the disk.
Result<WindHistory, Failure> read_wind_history(const std::filesystem::path& file, UtcTime now, unsigned hours,
                                               const std::stop_token& stop = {});

}  // namespace yuragi::daemon::history
