#include "drivers/windlog/windlog_writer.hpp"

#include <string>
#include <utility>

#include "drivers/windlog/format.hpp"

namespace yuragi::drivers::windlog {
namespace {

// At the end a reader can make a writer wait, not for long.
constexpr int kCloseTimeout_ms = 200;

std::int64_t nanoseconds(MonoTime time) {
  return time.time_since_epoch().count();
}
std::int64_t nanoseconds(UtcTime time) {
  return time.time_since_epoch().count();
}

/// Is it an empty database, or a recording that this version writes?
Result<bool, Failure> is_new(sqlite::Database& database) {
  const std::string name = database.file().string();
  const auto application = database.integer("PRAGMA application_id");
  if (!application) return application.error();
  const auto version = database.integer("PRAGMA user_version");
  if (!version) return version.error();
  const auto objects = database.integer("SELECT count(*) FROM sqlite_schema");
  if (!objects) return objects.error();

  if (*application == 0 && *objects == 0) return true;
  if (*application != kApplicationId) {
    return Failure{name + ": is a database, but not a Yuragi recording; it was left unchanged; choose another file"};
  }
  if (*version > kFormatVersion) {
    return Failure{name + ": was written by a newer Yuragi (format " + std::to_string(*version) + ", this one writes " +
                   std::to_string(kFormatVersion) + "); update Yuragi, or choose another file"};
  }
  return false;
}

}  // namespace

bool is_recordable(const wind::WindReading& reading) noexcept {
  const std::int64_t utc_ns = nanoseconds(reading.time.utc);
  const std::int64_t mono_ns = nanoseconds(reading.time.mono);
  return wind::is_plausible(reading) && mono_ns >= 0 && mono_ns <= kMaxTime_ns && utc_ns >= -kMaxTime_ns &&
         utc_ns <= kMaxTime_ns;
}

Result<WindlogWriter, Failure> WindlogWriter::open(const std::filesystem::path& file) {
  auto database = sqlite::Database::open(file, sqlite::Access::kReadWrite);
  if (!database) return database.error();
  WindlogWriter writer(std::move(*database));
  if (const auto done = writer.prepare_file(); !done) {
    writer.release();
    return done.error();
  }
  return writer;
}

Result<void, Failure> WindlogWriter::prepare_file() {
  database_.set_busy_timeout(sqlite::kBusyTimeout_ms);

  // Nothing is written before the file is known to be ours.
  const auto fresh = is_new(database_);
  if (!fresh) return fresh.error();
  if (auto done = database_.run("PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL"); !done) return done;

  // In one transaction: the whole schema or nothing, even after a power cut.
  if (*fresh) {
    const std::string create = "BEGIN IMMEDIATE; PRAGMA application_id = " + std::to_string(kApplicationId) +
                               "; PRAGMA user_version = " + std::to_string(kFormatVersion) + ";" + kSchema + "COMMIT";
    if (auto done = database_.run(create.c_str()); !done) return done;
  }

  const auto prepare = [this](sqlite::Statement& statement, std::string_view sql) -> Result<void, Failure> {
    auto prepared = database_.prepare(sql);
    if (!prepared) return prepared.error();
    statement = std::move(*prepared);
    return {};
  };
  if (auto done = prepare(insert_session_,
                          "INSERT INTO session (started_utc_ns, started_mono_ns, software, configuration) "
                          "VALUES (?1, ?2, ?3, ?4)");
      !done) {
    return done;
  }
  if (auto done =
          prepare(insert_sensor_, "INSERT INTO sensor (session, name, driver, options) VALUES (?1, ?2, ?3, ?4)");
      !done) {
    return done;
  }
  return prepare(insert_reading_,
                 "INSERT INTO reading (session, sensor, utc_ns, mono_ns, speed_m_s, direction_deg, gust_m_s, quality) "
                 "VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8)");
}

WindlogWriter::~WindlogWriter() {
  if (database_.is_open()) static_cast<void>(close());
}

Result<void, Failure> WindlogWriter::begin_session(const WindlogSession& session) {
  insert_session_.bind(1, nanoseconds(session.started.utc));
  insert_session_.bind(2, nanoseconds(session.started.mono));
  insert_session_.bind(3, session.software);
  insert_session_.bind(4, session.configuration);
  if (auto done = write(insert_session_); !done) return done;
  session_ = database_.last_id();
  return {};
}

Result<std::int64_t, Failure> WindlogWriter::add_sensor(std::string_view name, std::string_view driver,
                                                        std::string_view options) {
  insert_sensor_.bind(1, session_);
  insert_sensor_.bind(2, name);
  insert_sensor_.bind(3, driver);
  insert_sensor_.bind(4, options);
  if (const auto done = write(insert_sensor_); !done) return done.error();
  return database_.last_id();
}

Result<void, Failure> WindlogWriter::append(std::int64_t sensor, const wind::WindReading& reading) {
  if (!is_recordable(reading)) return Failure{database_.file().string() + ": not a reading that can be recorded"};
  insert_reading_.bind(1, session_);
  insert_reading_.bind(2, sensor);
  insert_reading_.bind(3, nanoseconds(reading.time.utc));
  insert_reading_.bind(4, nanoseconds(reading.time.mono));
  insert_reading_.bind(5, reading.speed_m_s);
  insert_reading_.bind(6, reading.direction_deg);
  insert_reading_.bind(7, reading.gust_m_s);
  insert_reading_.bind(8, static_cast<std::int64_t>(reading.quality));
  return write(insert_reading_);
}

Result<void, Failure> WindlogWriter::commit() {
  if (!database_.in_transaction()) return {};
  if (!database_.run("COMMIT")) return undo();
  return {};
}

Result<void, Failure> WindlogWriter::close() {
  const auto committed = commit();

  // Back into one file. A reader that has it open prevents that; what was committed is safe either way.
  database_.set_busy_timeout(kCloseTimeout_ms);
  const auto tidied = database_.run("PRAGMA wal_checkpoint(TRUNCATE); PRAGMA journal_mode = DELETE");
  const bool is_read_by_others =
      !tidied && (database_.error_code() == SQLITE_BUSY || database_.error_code() == SQLITE_LOCKED);
  release();
  return committed && !is_read_by_others ? tidied : committed;
}

void WindlogWriter::release() {
  insert_session_ = {};
  insert_sensor_ = {};
  insert_reading_ = {};
  database_.close();
}

/// Runs an INSERT, in a transaction.
Result<void, Failure> WindlogWriter::write(sqlite::Statement& statement) {
  if (!database_.in_transaction()) {
    if (auto begun = database_.run("BEGIN IMMEDIATE"); !begun) return begun;
  }
  const bool written = statement.step() == sqlite::Statement::Step::kDone;
  if (!written) {
    auto undone = undo();
    statement.reset();
    return undone;
  }
  statement.reset();
  return {};
}

/// Rolls back to the last commit; returns the failure that led to it.
Result<void, Failure> WindlogWriter::undo() {
  Failure failure = database_.failure();
  // SQLite rolls back by itself after some errors.
  if (database_.in_transaction()) static_cast<void>(database_.run("ROLLBACK"));
  return failure;
}

}  // namespace yuragi::drivers::windlog
