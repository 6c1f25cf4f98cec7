#include "daemon/recording/clock_synchronization.hpp"

#include <chrono>
#include <system_error>

#include "daemon/recording/clock_judge.hpp"

namespace yuragi::daemon::recording {

bool is_synchronized(const std::filesystem::path& file, UtcTime now) {
  std::error_code error;
  const auto written = std::filesystem::last_write_time(file, error);
  if (error) return false;
  // The moment that is judged can be a little in the past.
  constexpr double kMaxWait_s = 60.0;
  const double age_s =
      seconds(now.time_since_epoch()) - seconds(std::chrono::file_clock::to_sys(written).time_since_epoch());
  return age_s >= -kMaxWait_s && age_s <= seconds(kMaxClockStep);
}

}  // namespace yuragi::daemon::recording
