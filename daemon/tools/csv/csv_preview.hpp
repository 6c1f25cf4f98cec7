#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/base/time.hpp"
#include "engine/wind/wind_reading.hpp"

namespace yuragi::daemon::tools::csv {

/// What readings look like together, so that a person, or implausible(), sees a wrong column, unit or clock. Memory is
/// bounded. Thread-safe: no.
class Preview {
 public:
  /// Take them in the order in which they are recorded.
  void take(std::string_view sensor, const wind::Reading& reading);

  /// First and last time, interval, gaps, mean, strongest, largest change and directions, a line each. Empty without a
  /// reading.
  std::vector<std::string> describe() const;

  /// Why these are hardly winds, each with its figure: an interval below 10 ms, a mean above 40 m/s, changes above
  /// 10 m/s in 30 % of the steps. Empty if nothing is.
  std::vector<std::string> implausible() const;

 private:
  struct Last {
    MonoTime time;
    double speed_m_s = 0.0;
  };

  Nanoseconds usual_step() const;
  double mean_m_s() const;

  std::map<std::string, Last, std::less<>> last_;                 ///< of each sensor
  std::pair<std::int64_t, std::size_t*> last_step_{-1, nullptr};  ///< in steps_
  std::map<std::int64_t, std::size_t> steps_;  ///< how often each comes, in nanoseconds of two digits
  std::optional<Instant> first_;
  UtcTime last_utc_;
  std::size_t count_ = 0;
  std::size_t step_count_ = 0;
  Nanoseconds step_sum_{0};
  double speed_sum_m_s_ = 0.0;
  double strongest_m_s_ = 0.0;
  double strongest_gust_m_s_ = 0.0;
  std::size_t gusts_ = 0;
  double greatest_change_m_s_ = 0.0;
  std::size_t great_changes_ = 0;
  std::size_t with_direction_ = 0;
  std::array<std::size_t, 16> sectors_{};
};

}  // namespace yuragi::daemon::tools::csv
