#include "daemon/history/new_readings.hpp"

#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <ratio>
#include <set>
#include <string>
#include <system_error>
#include <vector>

#include "drivers/windlog/recording_parts.hpp"
#include "drivers/windlog/stored_file.hpp"

namespace yuragi::daemon::history {
namespace {

namespace fs = std::filesystem;
using drivers::windlog::LoggedReading;
using drivers::windlog::ReadingBlocks;
using drivers::windlog::StoredFile;

/// What is added at once: after a crash no more is read again, and no more steps wait in memory.
constexpr std::size_t kMaxReadingsAtOnce = 1'000'000;
constexpr std::size_t kMaxStepsAtOnce = 2000;

/// Where its step begins, in s since 1970, UTC.
std::int64_t step_begin_s(UtcTime moment) {
  return kKeptStep_s * std::chrono::floor<std::chrono::duration<std::int64_t, std::ratio<kKeptStep_s>>>(moment)
                           .time_since_epoch()
                           .count();
}

/// Adds one sensor's readings of one file. Returns false if the file is damaged.
Result<bool, Failure> add_sensor(ReadingBlocks& blocks, const ReadPlace& place, MeansFile& means) {
  auto before = means.read_to(place);
  if (!before) return before.error();
  blocks.seek(*before ? **before + Nanoseconds(1) : Nanoseconds(0));
  std::vector<LoggedReading> block;
  std::size_t skipped = 0;
  for (bool is_end = false; !is_end;) {
    std::map<std::int64_t, Step> steps;
    std::optional<Nanoseconds> read_to;
    bool is_sound = true;
    for (std::size_t count = 0; count < kMaxReadingsAtOnce && steps.size() < kMaxStepsAtOnce; count += block.size()) {
      is_sound = static_cast<bool>(blocks.read(block, skipped));
      is_end = !is_sound || block.empty();
      if (is_end) break;
      for (const LoggedReading& logged : block) steps[step_begin_s(logged.reading.time.utc)].add(logged.reading);
      read_to = block.back().log_time;
    }
    if (read_to) {
      if (const auto added = means.add(place, *before, *read_to, steps); !added) return added.error();
      before = read_to;
    }
    if (!is_sound) return false;
  }
  return true;
}

/// The same of all sensors.
Result<bool, Failure> add_file(const StoredFile& file, MeansFile& means) {
  const auto& readings = *file.readings;
  bool is_sound = true;
  std::set<std::string> names;
  for (const auto& sensor : readings.sensors) {
    if (readings.sessions.empty() || !names.insert(sensor.name).second) continue;
    const ReadPlace place{readings.sessions.front().first.utc.time_since_epoch().count(), sensor.name};
    std::vector<bool> of_sensors;
    for (const auto& other : readings.sensors) of_sensors.push_back(other.name == sensor.name);
    const auto streams = readings.blocks(of_sensors);
    is_sound = is_sound && streams;
    if (!streams) continue;
    for (const std::unique_ptr<ReadingBlocks>& blocks : *streams) {
      const auto added = add_sensor(*blocks, place, means);
      if (!added) return added.error();
      is_sound = is_sound && *added;
    }
  }
  return is_sound;
}

/// Adds what is new in a file. Returns false if it is damaged or cannot be opened.
Result<bool, Failure> add_new_of(const fs::path& file, bool is_completed, MeansFile& means,
                                 const std::stop_token& stop) {
  const std::string name = file.filename().string();
  std::error_code is_unknown;
  const std::uintmax_t bytes = fs::file_size(file, is_unknown);
  if (is_completed) {
    const auto is_known = means.has_all_of(name, bytes);
    if (!is_known || *is_known) return is_known;
  }
  const auto opened = drivers::windlog::open_stored_file(file, stop);
  if (!opened) return drivers::windlog::is_blank_file(file);
  const auto is_sound = add_file(*opened, means);
  if (is_sound && *is_sound && is_completed && !is_unknown) {
    if (const auto noted = means.note_all_of(name, bytes); !noted) return noted.error();
  }
  return is_sound;
}

}  // namespace

Result<std::size_t, Failure> add_new_readings(const fs::path& recording, MeansFile& means,
                                              const std::stop_token& stop) {
  const std::vector<fs::path> files = drivers::windlog::recording_files(recording);
  if (files.empty()) return drivers::windlog::check_is_file(recording).error();
  std::size_t left_out = 0;
  for (const fs::path& file : files) {
    const auto is_sound = add_new_of(file, file != recording, means, stop);
    if (stop.stop_requested()) return Failure{file.string() + ": reading was stopped"};
    if (!is_sound) return is_sound.error();
    if (!*is_sound) ++left_out;
  }
  return left_out;
}

}  // namespace yuragi::daemon::history
