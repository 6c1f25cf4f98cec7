#include "daemon/recording/clock_doubt_file.hpp"

#include <chrono>
#include <cstdint>
#include <exception>
#include <fstream>
#include <sstream>
#include <system_error>

#include "engine/platform/whole_file.hpp"

namespace yuragi::daemon::recording {

std::filesystem::path clock_doubt_file(const std::filesystem::path& recording) {
  return recording.string() + "-clock";
}

std::optional<ClockDoubt> read_clock_doubt(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return std::nullopt;
  std::int64_t since_s = 0;
  bool is_at_start = false;
  std::int64_t ahead_s = 0;
  std::int64_t running_s = 0;
  // Nobody's clock is older or newer, or jumps further, than Nanoseconds can hold.
  constexpr std::int64_t kMaxTime_s = std::chrono::floor<std::chrono::seconds>(Nanoseconds::max()).count();
  constexpr std::int64_t kDoubt_s = std::chrono::floor<std::chrono::seconds>(ClockJudge::kDoubt).count();
  if (!(std::ifstream(file) >> since_s >> is_at_start >> ahead_s >> running_s)) return std::nullopt;
  if (since_s < -kMaxTime_s || since_s > kMaxTime_s || ahead_s < -2 * kMaxTime_s || ahead_s > 2 * kMaxTime_s ||
      running_s < 0 || running_s >= kDoubt_s)
    return std::nullopt;
  return ClockDoubt{.since = std::chrono::sys_seconds(std::chrono::seconds(since_s)),
                    .is_at_start = is_at_start,
                    .ahead_s = ahead_s,
                    .running = std::chrono::seconds(running_s)};
}

bool write_clock_doubt(const std::filesystem::path& file, const std::optional<ClockDoubt>& doubt) {
  if (!doubt) {
    std::error_code error;
    std::filesystem::remove(file, error);
    return !error;
  }
  try {
    std::ostringstream text;
    text << doubt->since.time_since_epoch().count() << ' ' << doubt->is_at_start << ' ' << doubt->ahead_s << ' '
         << std::chrono::floor<std::chrono::seconds>(doubt->running).count() << '\n';
    return platform::write_whole(file, text.str()).has_value();
  } catch (const std::exception&) {
    return false;
  }
}

}  // namespace yuragi::daemon::recording
