#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "engine/base/result.hpp"
#include "engine/base/time.hpp"
#include "engine/wind/wind_reading.hpp"

namespace yuragi::drivers::windlog {

/// Which part of a recording is played, and how often.
struct PlaybackOptions {
  /// Where to begin: empty, seconds from the recording's first reading ("90", "12.5"), or a moment in ISO 8601
  /// ("2018-07-20T14:05:00Z"; UTC if it names no zone).
  std::string start = {};
  /// Begin again at `start` when the end is reached; log time runs on.
  bool loop = false;
  /// The name of the sensor to play; empty: the one with the first reading; "*": all of them.
  std::string sensor = {};
};

/// A reading of a recording, and when it is played.
struct PlayedReading {
  double log_time_s = 0.0;  ///< since the start of the playback; never less than that of the reading before
  wind::Reading reading;    ///< as recorded, its own time included
  std::string_view sensor;  ///< its sensor's name; lives as long as the playback
};

/// Plays a recording (.windlog) in log time, with no clock: the caller decides when a reading is due. Log time
/// follows the monotonic clock inside a session and the UTC gap between two sessions (never less than zero), so that
/// setting the clock of the recording machine neither stretches nor shrinks a replay.
///
/// Reads in blocks, so that the length of a recording does not matter, and holds no lock between them: a recording that
/// is still being written can be played up to its present end.
/// Thread-safe: no. Realtime-safe: no; it reads a file.
class Playback {
 public:
  /// Fails, naming the file and what to do, if it cannot be read, has no such sensor or no reading, or if `start`
  /// cannot be understood or lies after the end.
  static Result<Playback, Failure> open(const std::filesystem::path& file, const PlaybackOptions& options = {});
  ~Playback();
  Playback(Playback&&) noexcept;
  Playback& operator=(Playback&&) noexcept;

  /// Returns the next reading, in the order of log time; nullopt at the end (never, if it loops). Fails on a read
  /// error; the next call tries the same place again.
  Result<std::optional<PlayedReading>, Failure> next();

  /// Rows that were passed over because no reading can look like that; in this round, if it loops.
  std::size_t skipped() const;

 private:
  struct State;
  explicit Playback(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

class Cursor;

/// Moves a cursor to `start`, and returns that log time. Fails as Playback::open() does.
Result<Nanoseconds, Failure> begin_of_playback(Cursor& cursor, std::string_view start);

/// Is this a `start` that PlaybackOptions takes? The failure's text: what it takes.
Result<void, Failure> check_playback_start(std::string_view start);

}  // namespace yuragi::drivers::windlog
