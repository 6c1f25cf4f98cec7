#include "drivers/windlog/windlog_cursor.hpp"

#include <algorithm>
#include <utility>

namespace yuragi::drivers::windlog {
namespace {

constexpr Nanoseconds kUnknownInterval = std::chrono::seconds(1);
constexpr Nanoseconds kMinInterval = std::chrono::milliseconds(1);
// As many intervals as settle a median.
constexpr std::size_t kIntervalsMeasured = 64;

/// Makes any failure to read a recording one of its data, with any code of SQLite.
Failure of_data(const Failure& failure) {
  return {failure.message, failure.kind == FailureKind::kOther ? FailureKind::kBadData : failure.kind};
}

}  // namespace

Result<Cursor, Failure> Cursor::open(const std::filesystem::path& file, std::string_view sensor,
                                     const std::stop_token& stop) {
  auto reader = Reader::open(file, stop);
  if (!reader) return reader.error();
  Cursor cursor(std::move(*reader));
  if (const auto chosen = cursor.choose(sensor); !chosen) return chosen.error();
  const auto interval = cursor.measure_interval();
  if (!interval) return interval.error();
  cursor.interval_ = *interval;
  return cursor;
}

Result<void, Failure> Cursor::choose(std::string_view sensor) {
  const std::string file = reader_.file().string();
  std::string wanted(sensor);
  if (wanted.empty()) {
    const auto first = reader_.next();
    if (!first) return of_data(first.error());
    if (!*first) return Failure{file + ": there is no reading in this recording", FailureKind::kBadData};
    wanted = sensor_of(**first).name;
  }
  std::vector<bool> is_chosen;
  std::string known;
  for (const LoggedSensor& candidate : reader_.sensors()) {
    is_chosen.push_back(wanted == "*" || candidate.name == wanted);
    const std::string quoted = "\"" + candidate.name + "\"";
    if (known.find(quoted) == std::string::npos) known += (known.empty() ? " " : ", ") + quoted;
  }
  if (std::ranges::find(is_chosen, true) == is_chosen.end()) {
    return Failure{file + ": has no sensor \"" + wanted + "\"; it has" + known, FailureKind::kBadData};
  }
  const auto last = reader_.last_log_time(is_chosen);
  if (!last) return of_data(last.error());
  if (!*last) {
    return Failure{file + ": there is no reading of \"" + wanted + "\" in this recording", FailureKind::kBadData};
  }
  last_ = **last;
  if (const auto chosen = reader_.choose(is_chosen); !chosen) return of_data(chosen.error());
  return {};
}

Result<Nanoseconds, Failure> Cursor::measure_interval() {
  seek(Nanoseconds{0});
  std::vector<Nanoseconds> intervals;
  std::optional<Nanoseconds> before;
  while (intervals.size() < kIntervalsMeasured) {
    const auto logged = next();
    if (!logged) return logged.error();
    if (!*logged) break;
    if (before) intervals.push_back((*logged)->log_time - *before);
    before = (*logged)->log_time;
  }
  seek(Nanoseconds{0});
  if (intervals.empty()) return kUnknownInterval;
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::ranges::nth_element(intervals, middle);
  return std::max(*middle, kMinInterval);
}

Result<std::optional<LoggedReading>, Failure> Cursor::next() {
  const auto logged = reader_.next();
  if (!logged) return of_data(logged.error());
  return *logged;
}

void Cursor::seek(Nanoseconds log_time) {
  reader_.seek(log_time);
}

Result<std::optional<Nanoseconds>, Failure> Cursor::find(const LogMoment& moment) {
  const auto found = log_time_of(reader_, moment);
  if (!found) return of_data(found.error());
  return *found;
}

}  // namespace yuragi::drivers::windlog
