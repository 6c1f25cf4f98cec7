#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

#include "drivers/windlog/sqlite.hpp"
#include "engine/base/result.hpp"
#include "engine/base/time.hpp"
#include "engine/wind/wind_reading.hpp"

namespace yuragi::drivers::windlog {

/// What made a session of a recording.
struct WindlogSession {
  Instant started;
  std::string_view software;       ///< name and version
  std::string_view configuration;  ///< TOML, as read
};

/// Writes a recording (.windlog, format.hpp). What is committed survives the death of the process and a power cut; what
/// was written since is lost with either, so commit at least every half second.
///
/// A call that fails undoes everything since the last commit; its text names the file and what to do; the writer can be
/// used on (a full disk that has room again), or destroyed and opened again. Owns the open file. Thread-safe: no; one
/// thread. Realtime-safe: no; commit() waits for the disk.
class WindlogWriter {
 public:
  /// Opens a recording to append to, or creates it. Refuses a file that is something else, and one of a newer format,
  /// without changing it.
  static Result<WindlogWriter, Failure> open(const std::filesystem::path& file);

  WindlogWriter(WindlogWriter&&) noexcept = default;
  WindlogWriter& operator=(WindlogWriter&&) = delete;
  /// Closes, if close() was not called, without reporting errors.
  ~WindlogWriter();

  /// Begins a session, to which the sensors and readings that follow belong.
  Result<void, Failure> begin_session(const WindlogSession& session);

  /// Adds a sensor to the session; returns the id that append() takes.
  Result<std::int64_t, Failure> add_sensor(std::string_view name, std::string_view driver, std::string_view options);

  /// Adds a reading. One that is not plausible, or whose time cannot be, is a failure of the caller's and undoes
  /// nothing.
  Result<void, Failure> append(std::int64_t sensor, const wind::WindReading& reading);

  /// Makes everything so far durable.
  Result<void, Failure> commit();

  /// Commits and leaves one file, with nothing beside it (unless another program is reading it: then FILE-wal stays
  /// until the next writer closes it). Nothing may be called after it.
  Result<void, Failure> close();

 private:
  explicit WindlogWriter(sqlite::Database database) : database_(std::move(database)) {}

  Result<void, Failure> prepare_file();
  Result<void, Failure> write(sqlite::Statement& statement);
  Result<void, Failure> undo();
  void release();

  sqlite::Database database_;
  sqlite::Statement insert_session_;
  sqlite::Statement insert_sensor_;
  sqlite::Statement insert_reading_;
  std::int64_t session_ = 0;
};

/// Can this reading be recorded?
bool is_recordable(const wind::WindReading& reading) noexcept;

}  // namespace yuragi::drivers::windlog
