#include "drivers/windlog/windlog_playback.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

#include "drivers/windlog/log_moment.hpp"
#include "drivers/windlog/windlog_reader.hpp"

namespace yuragi {
namespace {

// Between the end and the next beginning of a loop: the recording's own mean interval, within these.
constexpr Nanoseconds kUnknownInterval = std::chrono::seconds(1);
constexpr Nanoseconds kMinSeam = std::chrono::milliseconds(1);

/// What is wrong with the recording as a whole, as an exception.
template <class T>
T value_or_throw(Result<T, Failure> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return std::move(*result);
}

}  // namespace

struct WindlogPlayback::State {
  State(WindlogReader opened, bool loops) : reader(std::move(opened)), loop(loops) {}

  WindlogReader reader;
  bool loop = false;
  std::vector<bool> is_played;  ///< by index of a sensor
  Nanoseconds begin{0};         ///< the log time at which the playback begins

  // The position. Log time of the playback = log time of the file + shift.
  Nanoseconds shift{0};
  Nanoseconds last{0};
  bool has_played = false;  ///< in this round

  // For the mean interval, which the first round measures.
  std::size_t last_session = 0;
  Nanoseconds last_in_file{0};
  Nanoseconds interval_sum{0};
  std::int64_t interval_count = 0;
  bool measured = false;

  std::optional<LoggedReading> next_of_file();
  void measure(const LoggedReading& logged);
  Nanoseconds seam() const;
};

/// The next reading of a sensor that is played; nothing at the end of the file.
std::optional<LoggedReading> WindlogPlayback::State::next_of_file() {
  for (;;) {
    const auto logged = value_or_throw(reader.next());
    if (!logged || is_played[logged->sensor]) return logged;
  }
}

/// Adds an interval inside a session to the mean.
void WindlogPlayback::State::measure(const LoggedReading& logged) {
  const auto session = static_cast<std::size_t>(reader.sensors()[logged.sensor].session);
  if (has_played && session == last_session) {
    interval_sum += logged.log_time - last_in_file;
    ++interval_count;
  }
  last_session = session;
  last_in_file = logged.log_time;
}

Nanoseconds WindlogPlayback::State::seam() const {
  return interval_count == 0 ? kUnknownInterval : std::max(interval_sum / interval_count, kMinSeam);
}

WindlogPlayback::WindlogPlayback(const std::filesystem::path& file, const PlaybackOptions& options) {
  const LogMoment start = value_or_throw(parse_log_moment(options.start));
  state_ = std::make_unique<State>(value_or_throw(WindlogReader::open(file)), options.loop);
  WindlogReader& reader = state_->reader;

  // Who plays?
  std::string wanted = options.sensor;
  if (wanted.empty()) {
    const auto first = value_or_throw(reader.next());
    if (!first) throw std::runtime_error(file.string() + ": there is no reading in this recording");
    wanted = reader.sensors()[first->sensor].name;
  }
  std::string known;
  bool found = false;
  for (const LoggedSensor& sensor : reader.sensors()) {
    const bool plays = wanted == "*" || sensor.name == wanted;
    state_->is_played.push_back(plays);
    found = found || plays;
    if (known.find("\"" + sensor.name + "\"") == std::string::npos) known += " \"" + sensor.name + "\"";
  }
  if (!found) throw std::runtime_error(file.string() + ": has no sensor \"" + wanted + "\"; it has" + known);

  // From where?
  const auto begin = value_or_throw(log_time_of(reader, start));
  if (!begin) throw std::runtime_error(file.string() + ": ends before " + options.start);
  state_->begin = *begin;
  state_->shift = -state_->begin;
  reader.seek(state_->begin);

  // There must be something to play, or a loop would look for it for ever.
  if (!state_->next_of_file()) {
    throw std::runtime_error(file.string() + ": has no reading of \"" + wanted + "\" from " +
                             (options.start.empty() ? "its beginning" : options.start) + " on; it is " +
                             std::to_string(seconds(reader.duration())) + " s long");
  }
  reader.seek(state_->begin);
}

WindlogPlayback::~WindlogPlayback() = default;
WindlogPlayback::WindlogPlayback(WindlogPlayback&&) noexcept = default;
WindlogPlayback& WindlogPlayback::operator=(WindlogPlayback&&) noexcept = default;

std::optional<PlayedReading> WindlogPlayback::next() {
  State& state = *state_;
  auto logged = state.next_of_file();
  if (!logged) {
    if (!state.loop) return std::nullopt;

    // The first reading of the next round comes one mean interval after the last one of this.
    state.measured = true;
    state.has_played = false;
    state.reader.seek(state.begin);
    logged = state.next_of_file();
    if (!logged) return std::nullopt;
    state.shift = state.last + state.seam() - logged->log_time;
  }
  if (!state.measured) state.measure(*logged);
  state.has_played = true;

  state.last = std::max(state.last, logged->log_time + state.shift);
  return PlayedReading{seconds(state.last), logged->reading, state.reader.sensors()[logged->sensor].name};
}

std::size_t WindlogPlayback::skipped() const {
  return state_->reader.skipped();
}

Result<void, Failure> check_playback_start(std::string_view start) {
  const auto parsed = parse_log_moment(start);
  if (!parsed) return parsed.error();
  return {};
}

}  // namespace yuragi
