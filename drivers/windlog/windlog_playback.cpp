#include "drivers/windlog/windlog_playback.hpp"

#include <algorithm>
#include <utility>

#include "drivers/windlog/windlog_cursor.hpp"

namespace yuragi::drivers::windlog {
namespace {

// Between the end and the next beginning of a loop: the recording's own mean interval, within these.
constexpr Nanoseconds kUnknownMeanInterval = std::chrono::seconds(1);
constexpr Nanoseconds kMinSeam = std::chrono::milliseconds(1);

}  // namespace

Result<Nanoseconds, Failure> begin_of_playback(Cursor& cursor, std::string_view start) {
  const auto moment = parse_log_moment(start);
  if (!moment) return moment.error();
  const std::string file = cursor.reader().file().string();
  const auto found = cursor.find(*moment);
  if (!found) return found.error();
  if (!*found) return Failure{file + ": ends before " + std::string(start), FailureKind::kBadData};
  const Nanoseconds begin = **found;

  // There must be something to play, or a loop would search without end.
  cursor.seek(begin);
  const auto first = cursor.next();
  if (!first) return first.error();
  if (!*first) {
    return Failure{file + ": has no reading from " + (start.empty() ? "its beginning" : std::string(start)) +
                       " on; its last one is at " + std::to_string(seconds(cursor.last())) + " s",
                   FailureKind::kBadData};
  }
  cursor.seek(begin);
  return begin;
}

struct Playback::State {
  State(Cursor opened, bool loops, Nanoseconds from)
      : cursor(std::move(opened)), loop(loops), begin(from), shift(-from) {}

  Cursor cursor;
  bool loop = false;
  Nanoseconds begin{0};  ///< the log time at which the playback begins

  // The position. Log time of the playback = log time of the file + shift.
  Nanoseconds shift{0};
  Nanoseconds last{0};
  bool has_played = false;  ///< in this round

  // For the mean interval, which the first round measures.
  std::int64_t last_session = 0;
  Nanoseconds last_in_file{0};
  Nanoseconds interval_sum{0};
  std::int64_t interval_count = 0;
  bool measured = false;

  void measure(const LoggedReading& logged);
  Nanoseconds seam() const;
};

/// Adds an interval inside a session to the mean.
void Playback::State::measure(const LoggedReading& logged) {
  const std::int64_t session = cursor.sensor_of(logged).session;
  if (has_played && session == last_session) {
    interval_sum += logged.log_time - last_in_file;
    ++interval_count;
  }
  last_session = session;
  last_in_file = logged.log_time;
}

Nanoseconds Playback::State::seam() const {
  return interval_count == 0 ? kUnknownMeanInterval : std::max(interval_sum / interval_count, kMinSeam);
}

Result<Playback, Failure> Playback::open(const std::filesystem::path& file, const PlaybackOptions& options) {
  auto cursor = Cursor::open(file, options.sensor);
  if (!cursor) return cursor.error();
  const auto begin = begin_of_playback(*cursor, options.start);
  if (!begin) return begin.error();
  return Playback(std::make_unique<State>(std::move(*cursor), options.loop, *begin));
}

Playback::Playback(std::unique_ptr<State> state) : state_(std::move(state)) {}

Playback::~Playback() = default;
Playback::Playback(Playback&&) noexcept = default;
Playback& Playback::operator=(Playback&&) noexcept = default;

Result<std::optional<PlayedReading>, Failure> Playback::next() {
  State& state = *state_;
  auto read = state.cursor.next();
  if (read && !*read) {
    if (!state.loop) return std::optional<PlayedReading>{};

    // The first reading of the next round comes one mean interval after the last one of this.
    state.measured = true;
    state.has_played = false;
    state.cursor.seek(state.begin);
    read = state.cursor.next();
    if (read && *read) state.shift = state.last + state.seam() - (*read)->log_time;
  }
  if (!read) return read.error();
  const std::optional<LoggedReading>& logged = *read;
  if (!logged) return std::optional<PlayedReading>{};
  if (!state.measured) state.measure(*logged);
  state.has_played = true;

  state.last = std::max(state.last, logged->log_time + state.shift);
  return std::optional(PlayedReading{seconds(state.last), logged->reading, state.cursor.sensor_of(*logged).name});
}

std::size_t Playback::skipped() const {
  return state_->cursor.reader().skipped();
}

Result<void, Failure> check_playback_start(std::string_view start) {
  const auto parsed = parse_log_moment(start);
  if (!parsed) return parsed.error();
  return {};
}

}  // namespace yuragi::drivers::windlog
