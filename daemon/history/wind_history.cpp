#include "daemon/history/wind_history.hpp"

#include <algorithm>
#include <array>

#include "drivers/windlog/windlog_reader.hpp"

namespace yuragi::daemon::history {
namespace {

constexpr std::int64_t kSecondsPerHour = 3600;

/// Lengths that divide an hour, so that steps begin at round times.
std::int64_t step_of(unsigned hours) {
  constexpr std::array<std::int64_t, 10> kLengths_s = {10, 20, 30, 60, 120, 180, 300, 600, 900, 1800};
  const auto enough = std::ranges::find_if(
      kLengths_s, [hours](std::int64_t length_s) { return hours * kSecondsPerHour / length_s <= kMaxSteps; });
  return enough == kLengths_s.end() ? kSecondsPerHour : *enough;
}

void add(Step& step, const wind::Reading& reading) {
  const bool is_first = step.readings++ == 0;
  step.sum_m_s += reading.speed_m_s;
  step.min_m_s = is_first ? reading.speed_m_s : std::min(step.min_m_s, reading.speed_m_s);
  step.max_m_s = is_first ? reading.speed_m_s : std::max(step.max_m_s, reading.speed_m_s);
  if (reading.direction_deg)
    step.vector_sum_m_s = step.vector_sum_m_s + wind::wind_from(reading.speed_m_s, *reading.direction_deg);
}

/// The history of that name, which is added if there is none; null if there are enough.
SensorHistory* sensor_named(const std::string& name, WindHistory& history) {
  const auto found = std::ranges::find(history.sensors, name, &SensorHistory::name);
  if (found != history.sensors.end()) return &*found;
  if (history.sensors.size() == kMaxSensors) return nullptr;
  history.sensors.push_back({name, std::vector<Step>(history.step_count)});
  return &history.sensors.back();
}

}  // namespace

Result<WindHistory, Failure> read_wind_history(const std::filesystem::path& file, UtcTime now, unsigned hours,
                                               const std::stop_token& stop) {
  const std::int64_t now_s = std::chrono::floor<std::chrono::seconds>(now).time_since_epoch().count();
  WindHistory history{.step_s = step_of(hours)};
  const std::int64_t last_s = now_s - now_s % history.step_s;
  history.begin_s = last_s - hours * kSecondsPerHour / history.step_s * history.step_s;
  history.step_count = static_cast<std::size_t>((last_s - history.begin_s) / history.step_s) + 1;

  auto reader = drivers::windlog::Reader::open(file, stop);
  if (!reader) return reader.error();
  const auto begin = reader->log_time_of(UtcTime(std::chrono::seconds(history.begin_s)));
  if (!begin) return begin.error();
  if (!*begin) return history;  // all of it is older
  reader->seek(**begin);
  for (;;) {
    const auto logged = reader->next();
    if (!logged) return logged.error();
    if (!*logged) return history;
    const wind::Reading& reading = (*logged)->reading;
    const std::int64_t utc_s =
        std::chrono::floor<std::chrono::seconds>(reading.time.utc).time_since_epoch().count() - history.begin_s;
    const auto step = static_cast<std::size_t>(utc_s / history.step_s);
    if (utc_s < 0 || step >= history.step_count) continue;  // the clock was set
    SensorHistory* const sensor = sensor_named(reader->sensors()[(*logged)->sensor].name, history);
    if (sensor != nullptr) add(sensor->steps[step], reading);
  }
}

}  // namespace yuragi::daemon::history
