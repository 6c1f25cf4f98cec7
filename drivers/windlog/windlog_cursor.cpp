#include "drivers/windlog/windlog_cursor.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace yuragi {
namespace {

constexpr Nanoseconds kUnknownInterval = std::chrono::seconds(1);
constexpr Nanoseconds kLeastInterval = std::chrono::milliseconds(1);
// As many intervals as settle a median.
constexpr std::size_t kIntervalsMeasured = 64;

/// What is wrong with the recording as a whole, as an exception.
template <class T>
T read_or_throw(Result<T, Failure> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return std::move(*result);
}

}  // namespace

WindlogCursor::WindlogCursor(const std::filesystem::path& file, std::string_view sensor)
    : reader_(read_or_throw(WindlogReader::open(file))) {
  std::string wanted(sensor);
  if (wanted.empty()) {
    const auto first = read_or_throw(reader_.next());
    if (!first) throw std::runtime_error(file.string() + ": there is no reading in this recording");
    wanted = sensor_of(*first).name;
  }
  std::string known;
  for (const LoggedSensor& candidate : reader_.sensors()) {
    is_chosen_.push_back(wanted == "*" || candidate.name == wanted);
    const std::string quoted = "\"" + candidate.name + "\"";
    if (known.find(quoted) == std::string::npos) known += " " + quoted;
  }
  if (std::ranges::find(is_chosen_, true) == is_chosen_.end()) {
    throw std::runtime_error(file.string() + ": has no sensor \"" + wanted + "\"; it has" + known);
  }

  const auto last = read_or_throw(reader_.last_log_time(is_chosen_));
  if (!last) throw std::runtime_error(file.string() + ": there is no reading of \"" + wanted + "\" in this recording");
  last_ = *last;
  interval_ = measure_interval();
}

Nanoseconds WindlogCursor::measure_interval() {
  seek(Nanoseconds{0});
  std::vector<Nanoseconds> intervals;
  std::optional<Nanoseconds> before;
  while (intervals.size() < kIntervalsMeasured) {
    const auto logged = next();
    if (!logged) break;
    if (before) intervals.push_back(logged->log_time - *before);
    before = logged->log_time;
  }
  seek(Nanoseconds{0});
  if (intervals.empty()) return kUnknownInterval;
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::ranges::nth_element(intervals, middle);
  return std::max(*middle, kLeastInterval);
}

std::optional<LoggedReading> WindlogCursor::next() {
  for (;;) {
    const auto logged = read_or_throw(reader_.next());
    if (!logged || is_chosen_[logged->sensor]) return logged;
  }
}

void WindlogCursor::seek(Nanoseconds log_time) {
  reader_.seek(log_time);
}

std::optional<Nanoseconds> WindlogCursor::find(const LogMoment& moment) {
  return read_or_throw(log_time_of(reader_, moment));
}

}  // namespace yuragi
