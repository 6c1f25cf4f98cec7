#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "drivers/windlog/logged.hpp"
#include "drivers/windlog/merged_readings.hpp"
#include "drivers/windlog/sqlite.hpp"
#include "drivers/windlog/stored_readings.hpp"
#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi::drivers::windlog {

/// Reads a recording (.windlog, format.hpp) of this version or an older one, in blocks, in the order of log time:
/// sessions one after the other, inside a session by the monotonic clock, between two by the UTC gap (at least zero).
///
/// A file's content is not trusted: rows that cannot be readings are skipped and counted; a file that is no recording,
/// or is damaged, is a failure.
///
/// A recording that is a series of files (recording_parts.hpp) is read as one, by the name of the file that is written.
/// Files of it that are damaged are left out (damage()); only if all are, the series is a failure. Reads a recording
/// that another process is writing (the readings committed so far, and later ones as they come), and one that a killed
/// process left with FILE-wal beside it; SQLite then creates FILE-shm, which needs a folder that can be written to.
/// Where nothing can be created it reads files that were properly closed, and refuses others with the reason. Owns the
/// open file; holds no lock between calls. Thread-safe: no. Realtime-safe: no.
class Reader {
 public:
  /// `stop`: a request of it ends this call, and later ones, within milliseconds with a failure.
  static Result<Reader, Failure> open(const std::filesystem::path& file, const std::stop_token& stop = {});

  const std::filesystem::path& file() const { return file_; }
  /// Those with readings, in order; as of open().
  std::span<const LoggedSession> sessions() const { return stored_->sessions; }
  /// Of all sessions: one that was used in three of them is here three times.
  std::span<const LoggedSensor> sensors() const { return stored_->sensors; }
  /// Files of a series that cannot be read and are left out, each as a sentence with its name and span; so far.
  std::vector<std::string> damage() const { return stored_->damage(); }
  /// The log time of the last reading, as of open(); zero for a recording without any.
  Nanoseconds duration() const { return sessions().empty() ? Nanoseconds{0} : sessions().back().log_end(); }

  /// The configuration text of a session.
  Result<std::string, Failure> configuration(std::int64_t session) const { return stored_->configuration(session); }

  /// Makes next() give the readings of those sensors only (one flag for each of sensors()), from the beginning. Without
  /// it, it gives all.
  Result<void, Failure> choose(const std::vector<bool>& of_sensors);

  /// Returns the next reading; nullopt at the end, until more has been recorded. After a failure the next call tries
  /// the same place again.
  Result<std::optional<LoggedReading>, Failure> next();

  /// Makes next() return the first reading at or after a log time.
  void seek(Nanoseconds log_time) { readings_->seek(log_time); }

  /// Returns the log time of the first reading at or after a moment; nullopt if all are before it. If the clock was set
  /// back across that moment, which then occurs more than once, it may be that of a later time.
  Result<std::optional<Nanoseconds>, Failure> log_time_of(UtcTime moment) { return stored_->log_time_of(moment); }

  /// Returns the log time of the last reading of those sensors (one flag for each of sensors()); nullopt if they have
  /// no reading.
  Result<std::optional<Nanoseconds>, Failure> last_log_time(const std::vector<bool>& of_sensors) {
    return stored_->last_log_time(of_sensors);
  }

  /// Passes the other quantities of stations, from one log time on and before another, to `use`, in order, independent
  /// of choose() and seek(). From zero on means all from the beginning, also what came before the first reading.
  /// Returns the number of impossible rows. A file of a series that has no readings is left out.
  Result<std::size_t, Failure> each_quantities(Nanoseconds from, Nanoseconds to, const UseQuantities& use) const {
    return stored_->each_quantities(from, to, use);
  }

  /// Writes a copy of the whole recording as it is at one moment, as one file, which must not exist yet. Fails for a
  /// series of files.
  Result<void, Failure> copy_to(const std::filesystem::path& copy);

  /// The same of one file, also if it is one of a series.
  static Result<void, Failure> copy_file(const std::filesystem::path& file, const std::filesystem::path& copy);

  /// Rows passed over since open() or the last seek().
  std::size_t skipped() const { return readings_->skipped(); }

 private:
  explicit Reader(std::filesystem::path file) : file_(std::move(file)) {}
  static Result<Reader, Failure> open(const std::filesystem::path& file,
                                      const std::vector<std::filesystem::path>& files, const std::stop_token& stop);

  std::filesystem::path file_;
  std::unique_ptr<sqlite::Database> database_;  ///< none for a series of files; what follows refers to it
  std::unique_ptr<StoredReadings> stored_;
  std::optional<MergedReadings> readings_;
};

}  // namespace yuragi::drivers::windlog
