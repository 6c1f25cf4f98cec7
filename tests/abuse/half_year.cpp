// yuragi-half-year: records a simulated half year as fast as the disk takes it, through the daemon's own recorder and
// with the times of its readings as the only clock, and says how much it had on the disk at any moment and what is
// left.
//
//   yuragi-half-year FILE.windlog DAYS INTERVAL_S KEEP_DAYS MAX_SIZE_MB MAX_FILE_MB MIN_FREE_MB     (0: no such rule)
//
// In each reading the speed says which day it is of. Prints JSON.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <span>
#include <system_error>

#include <fmt/format.h>

#include "daemon/recording/recorder.hpp"

namespace {

using namespace yuragi;

struct DiskUse {
  std::uint64_t recording_bytes = 0;  ///< all its files, with those that SQLite has beside them
  std::uint64_t files = 0;
  std::uint64_t free_bytes = 0;
};

DiskUse use_of(const std::filesystem::path& folder) {
  DiskUse use;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::uint64_t bytes = entry.file_size(error);
    if (error) continue;  // it has just been deleted
    use.recording_bytes += bytes;
    ++use.files;
  }
  use.free_bytes = std::filesystem::space(folder, error).available;
  return use;
}

void record(std::span<char*> arguments) {
  const std::filesystem::path file = arguments[1];
  const auto days = std::chrono::days(std::atoi(arguments[2]));
  const Nanoseconds interval = from_seconds(std::atof(arguments[3]));
  constexpr std::uint64_t kMegabyte = 1'000'000;
  daemon::settings::RecordingConfig rules;
  rules.is_daily = true;
  rules.keep_days = std::atoi(arguments[4]);
  rules.most_bytes = kMegabyte * std::strtoull(arguments[5], nullptr, 10);
  rules.most_file_bytes = kMegabyte * std::strtoull(arguments[6], nullptr, 10);
  rules.least_free_bytes = kMegabyte * std::strtoull(arguments[7], nullptr, 10);

  const Instant begin{MonoTime(std::chrono::hours(1)), UtcTime(std::chrono::sys_days(std::chrono::year(2026) / 1 / 1))};
  daemon::recording::Recorder recorder(
      file,
      {.started = begin, .software = "yuragi-half-year", .configuration = "", .sensors = {{"roof", "simulated", ""}}},
      {}, {.commit_every = std::chrono::milliseconds(1)}, rules);
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  DiskUse most;
  std::uint64_t least_free_bytes = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t pushed = 0;
  std::uint64_t looks = 0;
  // The clock goes on by six hours at most between two commits.
  constexpr std::uint64_t kMaxAtOnce = 5000;
  const std::uint64_t at_once =
      std::clamp<std::uint64_t>(static_cast<std::uint64_t>(std::chrono::hours(6) / interval), 1, kMaxAtOnce);
  for (Nanoseconds since{0}; since < days; since += interval) {
    wind::Reading reading;
    reading.time = {begin.mono + since, begin.utc + since};
    reading.speed_m_s = 0.1 * static_cast<double>(std::chrono::floor<std::chrono::days>(since).count());
    reading.direction_deg = std::chrono::duration<double>(since % std::chrono::days(1)).count() / 250.0;
    recorder.push(0, reading);
    if (++pushed % at_once != 0) continue;
    const auto is_done = [&](const daemon::recording::RecorderStatus& status) {
      return status.waiting == 0 || !status.error.empty();
    };
    recorder.wait_until(is_done, std::chrono::seconds(60));
    const DiskUse use = use_of(folder);
    most.recording_bytes = std::max(most.recording_bytes, use.recording_bytes);
    most.files = std::max(most.files, use.files);
    least_free_bytes = std::min(least_free_bytes, use.free_bytes);
    ++looks;
  }
  recorder.close();
  const auto status = recorder.status();
  const DiskUse left = use_of(folder);
  fmt::print(
      "{{\"pushed\": {}, \"written\": {}, \"lost\": {}, \"most_bytes\": {}, \"most_files\": {}, \"least_free_bytes\": "
      "{}, "
      "\"left_bytes\": {}, \"left_files\": {}, \"looks\": {}}}\n",
      pushed, status.written, status.lost, most.recording_bytes, most.files, least_free_bytes, left.recording_bytes,
      left.files, looks);
}

}  // namespace

int main(int argument_count, char** arguments) {
  constexpr int kArguments = 8;
  if (argument_count != kArguments) {
    std::fputs("usage: yuragi-half-year FILE DAYS INTERVAL_S KEEP_DAYS MAX_SIZE_MB MAX_FILE_MB MIN_FREE_MB\n", stderr);
    return 64;
  }
  try {
    record({arguments, kArguments});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "yuragi-half-year: %s\n", error.what());
    return 1;
  }
  return 0;
}
