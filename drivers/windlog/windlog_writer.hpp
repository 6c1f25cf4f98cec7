#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string_view>

#include "drivers/windlog/session_count.hpp"
#include "drivers/windlog/sqlite.hpp"
#include "engine/base/result.hpp"
#include "engine/base/time.hpp"
#include "engine/wind/station_quantities.hpp"
#include "engine/wind/wind_reading.hpp"

namespace yuragi::drivers::windlog {

/// What made a session of a recording.
struct Session {
  Instant started;
  std::string_view software;       ///< name and version
  std::string_view configuration;  ///< TOML, as read
};

/// When a recording is safe.
enum class Durability : std::uint8_t {
  kEachCommit,  ///< what is committed survives the death of the process and a power cut
  /// When it is closed, and the caller has brought it to the disk: for a file that nobody may read before. After a
  /// failure there is nothing to keep. Writes in two thirds of the time.
  kOnceClosed,
};

/// Writes a recording (.windlog, format.hpp). Whoever writes a series of files holds its SeriesLock. What is committed
/// survives the death of the process and a power cut; what was written since is lost with either, so commit often.
///
/// A call that fails undoes everything since the last commit; its text names the file and what to do; the writer can be
/// used on (a full disk that has room again), or destroyed and opened again. Owns the open file. Thread-safe: no; one
/// thread. Realtime-safe: no; commit() waits for the disk.
class Writer {
 public:
  /// Opens a recording to append to, or creates it. Refuses a file that is something else, and one of another version
  /// of the format (format.hpp), without changing it.
  static Result<Writer, Failure> open(const std::filesystem::path& file,
                                      Durability durability = Durability::kEachCommit);

  Writer(Writer&&) noexcept = default;
  Writer& operator=(Writer&&) = delete;
  /// Closes, if close() was not called, without reporting errors.
  ~Writer();

  /// Begins a session, to which the sensors and readings that follow belong; `started` must not be later than any of
  /// them.
  Result<void, Failure> begin_session(const Session& session);

  /// Notes which completed file was before this one in its series, by the moment in its name. Once for each file.
  Result<void, Failure> set_previous_part(UtcTime begin);

  /// Adds a sensor to the session; returns the id that append() takes. Fails if the recording would have readings of
  /// more than kMaxSeries names.
  Result<std::int64_t, Failure> add_sensor(std::string_view name, std::string_view driver, std::string_view options);

  /// Adds a reading. One that is not plausible, or whose time cannot be, is a failure of the caller's and undoes
  /// nothing. One that is earlier than its session is given the session's begin; one that has the time of another of
  /// its sensor's is moved to a nanosecond that is free.
  Result<void, Failure> append(std::int64_t sensor, const wind::Reading& reading);

  /// Adds readings of one sensor, as if one by one; in about half of the time if each is later than the one before.
  Result<void, Failure> append(std::int64_t sensor, std::span<const wind::Reading> readings);

  /// Adds the other quantities of a sensor's station, as far as they are plausible: one row a second (format.hpp).
  /// Returns false, with nothing undone, if they cannot be added: none is plausible, the time is impossible, there is
  /// no such sensor, or the file's table for them is damaged. A failure is one of the disk.
  Result<bool, Failure> append(std::int64_t sensor, const wind::StationQuantities& quantities);

  /// Returns when the first session of a file that has readings or quantities was begun; nullopt if it has none.
  Result<std::optional<UtcTime>, Failure> began();

  /// The time of the last reading before the session that was begun last, or when the session before that was begun if
  /// this is later in the recording. Nullopt if there was no session.
  std::optional<UtcTime> last_before_session() const { return last_before_session_; }

  /// The time of the last reading in the file, or when its last session was begun if that is later in the recording.
  /// Nullopt if the file has no session.
  Result<std::optional<UtcTime>, Failure> last_time();

  /// Makes everything so far durable.
  Result<void, Failure> commit();

  /// Brings what is committed from FILE-wal into FILE, as far as no reader holds that up: a copy of FILE alone has it
  /// then.
  Result<void, Failure> checkpoint();

  /// Commits and leaves one file, with nothing beside it (unless another program is reading it: then FILE-wal stays
  /// until the next writer closes it). Nothing may be called after it.
  Result<void, Failure> close();

 private:
  /// So many readings in one statement.
  static constexpr std::size_t kBatch = 32;

  /// Into a sensor's series.
  struct Insert {
    sqlite::Statement statement;
    std::optional<sqlite::Statement> batch = std::nullopt;  ///< of kBatch readings; prepared when it is first needed
    std::int64_t series = 0;
    std::int64_t last_since_ns = -1;  ///< of the latest reading, since the session's start
  };

  /// A place on the recording's time line, and the date there.
  struct Place {
    std::int64_t time_ns = 0;
    UtcTime utc;
  };

  explicit Writer(sqlite::Database database) : database_(std::move(database)) {}

  Result<void, Failure> prepare_file(Durability durability);
  Result<std::optional<Place>, Failure> last_place();
  Result<std::int64_t, Failure> begin_of_next_session(UtcTime started);
  Result<std::int64_t, Failure> series_named(std::string_view name);
  Result<void, Failure> make_series(std::int64_t series);
  Result<void, Failure> prepare_insert(std::int64_t sensor, std::int64_t series);
  Result<void, Failure> begin_transaction();
  bool prepare_quantities();
  bool fits_batch(const Insert& insert, std::span<const wind::Reading> readings) const;
  Result<void, Failure> append_batch(Insert& insert, std::span<const wind::Reading> readings);
  std::optional<std::int64_t> clock_ns_of(const wind::Reading& reading, std::int64_t since_ns) const;
  void count(const Insert& insert, const wind::Reading& reading, std::int64_t since_ns);
  std::optional<std::int64_t> last_quantities_ns();
  Result<void, Failure> write(sqlite::Statement& statement);
  Result<void, Failure> write_counts();
  void roll_back();
  Result<void, Failure> undo();
  void release();

  sqlite::Database database_;
  sqlite::Statement insert_session_;
  sqlite::Statement insert_sensor_;
  std::map<std::int64_t, Insert> insert_reading_;       ///< by sensor
  std::optional<sqlite::Statement> insert_quantities_;  ///< from the first ones on
  std::int64_t session_ = 0;
  /// Of the session, by series; nullopt after a failure: then it stores none.
  std::optional<std::map<std::int64_t, SessionCount>> counts_;
  std::int64_t begin_ns_ = 0;  ///< of the session, on the recording's time line
  Instant started_;
  std::optional<UtcTime> last_before_session_;
};

/// Can this reading be recorded?
bool is_recordable(const wind::Reading& reading) noexcept;

}  // namespace yuragi::drivers::windlog
