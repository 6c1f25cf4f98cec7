#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "drivers/windlog/sqlite.hpp"
#include "engine/base/result.hpp"
#include "engine/base/time.hpp"
#include "engine/wind/wind_reading.hpp"

namespace yuragi::drivers::windlog {

/// A session that has readings, on the line of log time.
struct LoggedSession {
  std::int64_t id = 0;
  std::string software;
  Instant first;             ///< of its first reading
  Instant last;              ///< of its last one, when the file was opened
  Nanoseconds log_begin{0};  ///< the log time of its first reading

  Nanoseconds log_end() const { return log_begin + (last.mono - first.mono); }
};

struct LoggedSensor {
  std::int64_t id = 0;
  std::int64_t session = 0;
  std::string name;
  std::string driver;
  std::string options;
};

struct LoggedReading {
  Nanoseconds log_time{0};    ///< since the recording's first reading
  std::size_t sensor = 0;     ///< index into WindlogReader::sensors()
  wind::WindReading reading;  ///< with the times of the recording machine
};

/// Reads a recording (.windlog, format.hpp), in blocks, in the order of log time: sessions one after the other, inside
/// a session by the monotonic clock, between two by the UTC gap (at least zero).
///
/// A file's content is not trusted: rows that cannot be readings are skipped and counted; a file that is no recording,
/// or is damaged, is a failure.
///
/// Reads a recording that another process is writing (the readings committed so far, and later ones as they come), and
/// one that a killed process left with FILE-wal beside it; SQLite then creates FILE-shm, which needs a folder that can
/// be written to. Where nothing can be created it reads files that were properly closed, and refuses others
/// with the reason.
/// Owns the open file; holds no lock between calls. Thread-safe: no. Realtime-safe: no.
class WindlogReader {
 public:
  static Result<WindlogReader, Failure> open(const std::filesystem::path& file);

  const std::filesystem::path& file() const { return database_.file(); }
  /// Those with readings, in order; as of open().
  std::span<const LoggedSession> sessions() const { return sessions_; }
  /// Of all sessions: one that was used in three of them is here three times.
  std::span<const LoggedSensor> sensors() const { return sensors_; }
  /// The log time of the last reading, as of open(); zero for a recording without any.
  Nanoseconds duration() const { return sessions_.empty() ? Nanoseconds{0} : sessions_.back().log_end(); }

  /// The configuration text of a session.
  Result<std::string, Failure> configuration(std::int64_t session);

  /// The next reading; nothing at the end, until more has been recorded. After a failure the next call tries the same
  /// place again.
  Result<std::optional<LoggedReading>, Failure> next();

  /// Makes next() return the first reading at or after a log time.
  void seek(Nanoseconds log_time);

  /// The log time of the first reading at or after a moment; nothing if all are before it. Scans one session.
  Result<std::optional<Nanoseconds>, Failure> log_time_of(UtcTime moment);

  /// The log time of the last reading of those sensors (one flag for each of sensors()); nothing if they have no
  /// reading. Walks back from the end to it.
  Result<std::optional<Nanoseconds>, Failure> last_log_time(const std::vector<bool>& of_sensors);

  /// Writes a copy of the whole recording as it is at one moment, as one file, which must not be there yet.
  Result<void, Failure> copy_to(const std::filesystem::path& copy);

  /// Rows passed over since open() or the last seek().
  std::size_t skipped() const { return skipped_; }

 private:
  explicit WindlogReader(sqlite::Database database) : database_(std::move(database)) {}

  static Result<WindlogReader, Failure> open_as(const std::filesystem::path& file, sqlite::Access access);
  Result<void, Failure> check_format();
  Result<void, Failure> load_sessions();
  Result<void, Failure> load_sensors();
  Result<std::int64_t, Failure> read_block();
  void begin_session(std::size_t index, Nanoseconds into_session);
  std::optional<LoggedReading> reading_of_row(const LoggedSession& session) const;

  sqlite::Database database_;
  sqlite::Statement select_block_;
  std::vector<LoggedSession> sessions_;
  std::vector<LoggedSensor> sensors_;

  // The block that next() hands out, and the place where the one after it begins.
  std::vector<LoggedReading> block_;
  std::size_t next_in_block_ = 0;
  std::size_t session_index_ = 0;
  std::int64_t after_mono_ns_ = 0;
  std::int64_t after_row_ = 0;
  std::size_t skipped_ = 0;
};

}  // namespace yuragi::drivers::windlog
