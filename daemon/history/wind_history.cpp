#include "daemon/history/wind_history.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "daemon/history/means_file.hpp"
#include "daemon/history/new_readings.hpp"
#include "drivers/windlog/windlog_reader.hpp"

namespace yuragi::daemon::history {
namespace {

constexpr std::int64_t kSecondsPerHour = 3600;

/// Lengths that divide a day, so that steps begin at round times.
std::int64_t step_of(unsigned hours) {
  constexpr std::array<std::int64_t, 15> kLengths_s = {10,  20,   30,   60,   120,   180,   300,  600,
                                                       900, 1800, 3600, 7200, 14400, 43200, 86400};
  const auto enough = std::ranges::find_if(
      kLengths_s, [hours](std::int64_t length_s) { return hours * kSecondsPerHour / length_s <= kMaxSteps; });
  return enough == kLengths_s.end() ? kLengths_s.back() : *enough;
}

/// The history of that name, which is added if there is none; null if there are enough.
SensorHistory* sensor_named(const std::string& name, WindHistory& history) {
  const auto found = std::ranges::find(history.sensors, name, &SensorHistory::name);
  if (found != history.sensors.end()) return &*found;
  if (history.sensors.size() == kMaxSensors) return nullptr;
  history.sensors.push_back({name, std::vector<Step>(history.step_count)});
  return &history.sensors.back();
}

/// The steps up to `now`, without sensors.
WindHistory empty_history(UtcTime now, unsigned hours) {
  const std::int64_t now_s = std::chrono::floor<std::chrono::seconds>(now).time_since_epoch().count();
  WindHistory history{.step_s = step_of(hours)};
  const std::int64_t last_s = now_s - now_s % history.step_s;
  history.begin_s = last_s - hours * kSecondsPerHour / history.step_s * history.step_s;
  history.step_count = static_cast<std::size_t>((last_s - history.begin_s) / history.step_s) + 1;
  return history;
}

Result<WindHistory, Failure> history_of_readings(const std::filesystem::path& file, WindHistory history,
                                                 const std::stop_token& stop) {
  auto reader = drivers::windlog::Reader::open(file, stop);
  if (!reader) return reader.error();
  const auto begin = reader->log_time_of(UtcTime(std::chrono::seconds(history.begin_s)));
  if (!begin) return begin.error();
  history.files_left_out = reader->damage().size();
  if (!*begin) return history;  // all of it is older
  reader->seek(**begin);
  for (;;) {
    const auto logged = reader->next();
    if (!logged) return logged.error();
    if (!*logged) {
      history.files_left_out = reader->damage().size();
      return history;
    }
    const wind::Reading& reading = (*logged)->reading;
    const std::int64_t utc_s =
        std::chrono::floor<std::chrono::seconds>(reading.time.utc).time_since_epoch().count() - history.begin_s;
    const auto step = static_cast<std::size_t>(utc_s / history.step_s);
    if (utc_s < 0 || step >= history.step_count) continue;  // the clock was set
    SensorHistory* const sensor = sensor_named(reader->sensors()[(*logged)->sensor].name, history);
    if (sensor != nullptr) sensor->steps[step].add(reading);
  }
}

Result<WindHistory, Failure> history_of_means(const std::filesystem::path& file, WindHistory history,
                                              const std::stop_token& stop) {
  auto means = MeansFile::open(means_file_of(file), stop);
  if (!means) return means.error();
  const auto left_out = add_new_readings(file, *means, stop);
  if (!left_out) return left_out.error();
  history.files_left_out = *left_out;
  const auto read = means->each_step(history.begin_s, history.step_s, static_cast<std::int64_t>(history.step_count),
                                     [&history](const std::string& name, std::int64_t index, const Step& step) {
                                       if (index < 0 || index >= static_cast<std::int64_t>(history.step_count)) return;
                                       SensorHistory* const sensor = sensor_named(name, history);
                                       if (sensor != nullptr) sensor->steps[static_cast<std::size_t>(index)] = step;
                                     });
  if (!read) return read.error();
  return history;
}

}  // namespace

bool is_of_means(unsigned hours) {
  return step_of(hours) % kKeptStep_s == 0;
}

Result<WindHistory, Failure> read_wind_history(const std::filesystem::path& file, UtcTime now, unsigned hours,
                                               const std::stop_token& stop) {
  WindHistory history = empty_history(now, hours);
  if (!is_of_means(hours)) return history_of_readings(file, std::move(history), stop);
  auto read = history_of_means(file, history, stop);
  if (read || read.error().kind != FailureKind::kBadData) return read;
  MeansFile::remove(means_file_of(file));  // damaged
  return history_of_means(file, std::move(history), stop);
}

}  // namespace yuragi::daemon::history
