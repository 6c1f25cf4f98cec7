#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi::drivers::windlog {

/// What a recording holds, in figures.
struct WindlogSummary {
  struct Sensor {
    std::string name;
    std::string driver;
    std::size_t count = 0;
    double mean_speed_m_s = 0.0;
    double max_speed_m_s = 0.0;
    double interval_s = 0.0;  ///< the median between two readings of a session; 0 for fewer than two
  };

  std::size_t count = 0;
  std::size_t skipped = 0;  ///< rows that cannot be readings
  std::size_t sessions = 0;
  Nanoseconds duration{0};  ///< in log time
  UtcTime first{};          ///< of the first and the last reading in log time
  UtcTime last{};
  std::vector<Sensor> sensors;  ///< by name, in the order of their first readings
};

/// Reads a whole recording once. Fails as WindlogReader does. Realtime-safe: no.
Result<WindlogSummary, Failure> summarize(const std::filesystem::path& file);

}  // namespace yuragi::drivers::windlog
