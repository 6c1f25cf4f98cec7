#include "drivers/windlog/windlog_writer.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "drivers/windlog/file_format.hpp"

namespace yuragi::drivers::windlog {
namespace {

// At the end a reader can make a writer wait, not for long.
constexpr int kCloseTimeout_ms = 200;
// Limit of the search, in nanoseconds, for a time that no other reading of the sensor has; beyond it the reading is put
// after the last.
constexpr int kMaxTries = 16;

std::int64_t nanoseconds(MonoTime time) {
  return time.time_since_epoch().count();
}
std::int64_t nanoseconds(UtcTime time) {
  return time.time_since_epoch().count();
}

/// The readings of all series as one table, for other programs that read the file.
std::string view_of(std::int64_t series) {
  std::string view = "DROP VIEW IF EXISTS reading; CREATE VIEW reading AS";
  for (std::int64_t each = 1; each <= series; ++each) {
    const std::string number = std::to_string(each);
    view += each == 1 ? "\n" : "\nUNION ALL ";
    view.append("SELECT session.id AS session, (SELECT name FROM series WHERE id = ").append(number);
    view +=
        ") AS sensor, started_utc_ns + (time_ns - begin_ns) + clock_ns AS utc_ns, "
        "started_mono_ns + (time_ns - begin_ns) AS mono_ns, speed_m_s, direction_deg, gust_m_s, quality FROM reading_";
    view.append(number).append(
        " JOIN session ON begin_ns = (SELECT max(begin_ns) FROM session WHERE begin_ns <= time_ns)");
  }
  return view;
}

/// Returns true for an empty database, and for a recording that this version writes.
Result<bool, Failure> is_new(sqlite::Database& database) {
  const std::string name = database.file().string();
  const auto format = format_of(database);
  if (!format) return format.error();
  if (format->is_blank()) return true;
  if (!format->is_recording()) {
    return Failure{name + ": is a database, but not a Yuragi recording; it was left unchanged; choose another file"};
  }
  if (format->version > kFormatVersion) {
    return Failure{name + ": was written by a newer Yuragi (format " + std::to_string(format->version) +
                   ", this one writes " + std::to_string(kFormatVersion) + "); update Yuragi, or choose another file"};
  }
  if (format->version < kFormatVersion) {
    return Failure{name + ": was written by an older Yuragi (format " + std::to_string(format->version) +
                   ", this one writes " + std::to_string(kFormatVersion) +
                   "); it can be read, but not continued; choose another file"};
  }
  return false;
}

Failure no_room(const sqlite::Database& database) {
  return Failure{database.file().string() + ": its last times are too late for another session; choose another file"};
}

}  // namespace

bool is_recordable(const wind::Reading& reading) noexcept {
  const std::int64_t utc_ns = nanoseconds(reading.time.utc);
  const std::int64_t mono_ns = nanoseconds(reading.time.mono);
  return wind::is_plausible(reading) && mono_ns >= 0 && mono_ns <= kMaxTime_ns && utc_ns >= -kMaxTime_ns &&
         utc_ns <= kMaxTime_ns;
}

Result<Writer, Failure> Writer::open(const std::filesystem::path& file, Durability durability) {
  auto database = sqlite::Database::open(file, sqlite::Access::kReadWrite);
  if (!database) return database.error();
  Writer writer(std::move(*database));
  if (const auto done = writer.prepare_file(durability); !done) {
    writer.release();
    return done.error();
  }
  return writer;
}

Result<void, Failure> Writer::prepare_file(Durability durability) {
  database_.set_busy_timeout(sqlite::kBusyTimeout_ms);

  // Nothing is written before the file is known to be ours.
  const auto fresh = is_new(database_);
  if (!fresh) return fresh.error();
  const char* const journal = durability == Durability::kEachCommit
                                  ? "PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL"
                                  : "PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF";
  if (auto done = database_.run(journal); !done) return done;

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
                          "INSERT INTO session (begin_ns, started_utc_ns, started_mono_ns, software, configuration) "
                          "VALUES (?1, ?2, ?3, ?4, ?5)");
      !done) {
    return done;
  }
  if (auto done =
          prepare(insert_sensor_, "INSERT INTO sensor (session, series, driver, options) VALUES (?1, ?2, ?3, ?4)");
      !done) {
    return done;
  }
  return {};
}

Writer::~Writer() {
  if (database_.is_open()) static_cast<void>(close());
}

Result<void, Failure> Writer::begin_session(const Session& session) {
  if (auto done = write_counts(); !done) return done;
  insert_reading_.clear();
  const auto begin_ns = begin_of_next_session(session.started.utc);
  if (!begin_ns) return begin_ns.error();
  begin_ns_ = *begin_ns;
  started_ = session.started;
  insert_session_.bind(1, begin_ns_);
  insert_session_.bind(2, nanoseconds(session.started.utc));
  insert_session_.bind(3, nanoseconds(session.started.mono));
  insert_session_.bind(4, session.software);
  insert_session_.bind(5, session.configuration);
  if (auto done = write(insert_session_); !done) return done;
  session_ = database_.last_id();
  counts_.emplace();
  return {};
}

Result<void, Failure> Writer::set_previous_part(UtcTime begin) {
  if (auto begun = begin_transaction(); !begun) return begun;
  const std::string table(kPreviousPartTable);
  const std::string statements = "CREATE TABLE IF NOT EXISTS " + table + " " + std::string(kPreviousPartColumns) +
                                 "; INSERT INTO " + table + " VALUES (" + std::to_string(nanoseconds(begin)) + ")";
  return database_.run(statements.c_str()) ? Result<void, Failure>{} : undo();
}

/// Stores what the session that ends wrote; in the transaction of its last readings, or in one of its own.
Result<void, Failure> Writer::write_counts() {
  const auto counts = std::exchange(counts_, std::nullopt);
  if (!counts || counts->empty()) return {};
  if (auto begun = begin_transaction(); !begun) return begun;
  const std::string table(kSessionCountTable);
  const std::string create = "CREATE TABLE IF NOT EXISTS " + table + " " + std::string(kSessionCountColumns);
  if (!database_.run(create.c_str())) return undo();
  auto insert = database_.prepare("INSERT INTO " + table + " VALUES (?1, ?2, ?3, ?4)");
  if (!insert) return undo();
  for (const auto& [series, count] : *counts) {
    insert->bind(1, session_);
    insert->bind(2, series);
    insert->bind(3, static_cast<std::int64_t>(count.readings));
    insert->bind(4, static_cast<std::int64_t>(count.checksum));
    if (auto done = write(*insert); !done) return done;
  }
  return {};
}

/// Where the last reading or the last beginning of a session is; nullopt if there is no session.
Result<std::optional<Writer::Place>, Failure> Writer::last_place() {
  const auto sessions = database_.integer("SELECT count(*) FROM session");
  if (!sessions) return sessions.error();
  if (*sessions == 0) return std::optional<Place>{};
  const auto count = database_.integer("SELECT count(*) FROM series");
  if (!count) return count.error();

  std::string last =
      "SELECT time_ns, begin_ns, started_utc_ns, clock_ns FROM (SELECT max(begin_ns) AS time_ns, "
      "0 AS clock_ns FROM session";
  for (std::int64_t series = 1; series <= *count; ++series) {
    const std::string table = "reading_" + std::to_string(series);
    last += " UNION ALL SELECT * FROM (SELECT time_ns, clock_ns FROM " + table + " ORDER BY time_ns DESC LIMIT 1)";
  }
  last +=
      ") JOIN session ON begin_ns = (SELECT max(begin_ns) FROM session WHERE begin_ns <= time_ns) "
      "ORDER BY time_ns DESC LIMIT 1";
  auto row = database_.prepare(last);
  if (!row) return row.error();
  if (row->step() != sqlite::Statement::Step::kRow) return undo().error();
  const std::int64_t time_ns = row->integer(0);
  std::int64_t utc_ns = 0;
  if (__builtin_add_overflow(row->integer(2) + (time_ns - row->integer(1)), row->integer(3), &utc_ns)) {
    return no_room(database_);
  }
  return std::optional(Place{time_ns, UtcTime(Nanoseconds(utc_ns))});
}

Result<std::optional<UtcTime>, Failure> Writer::last_time() {
  const auto last = last_place();
  if (!last) return last.error();
  return *last ? std::optional((*last)->utc) : std::nullopt;
}

/// Where a session begins on the recording's time line: after all that is there, by the UTC gap to the last reading or
/// the last beginning.
Result<std::int64_t, Failure> Writer::begin_of_next_session(UtcTime started) {
  const auto last = last_place();
  if (!last) return last.error();
  if (!*last) return 0;
  std::int64_t gap_ns = 0;
  std::int64_t begin_ns = 0;
  if (__builtin_sub_overflow(nanoseconds(started), nanoseconds((*last)->utc), &gap_ns) ||
      __builtin_add_overflow((*last)->time_ns, std::max<std::int64_t>(gap_ns, 1), &begin_ns) ||
      begin_ns >= kMaxTime_ns) {
    return no_room(database_);
  }
  last_before_session_ = (*last)->utc;
  // Nor before the last quantities of stations: the clock may have been set back since.
  if (const auto said_ns = last_quantities_ns(); said_ns && *said_ns < kMaxTime_ns - 1) {
    begin_ns = std::max(begin_ns, *said_ns + 1);
  }
  return begin_ns;
}

/// Returns the place of the last quantities on the recording's time line; nullopt if there are none, or their table is
/// damaged.
std::optional<std::int64_t> Writer::last_quantities_ns() {
  const std::string table(kQuantityTable);
  auto last = database_.prepare("SELECT time_ns FROM " + table + " WHERE typeof(time_ns) = 'integer' AND time_ns < " +
                                std::to_string(kMaxTime_ns) + " ORDER BY time_ns DESC LIMIT 1");
  if (!last || last->step() != sqlite::Statement::Step::kRow) return std::nullopt;
  return last->integer(0);
}

Result<std::int64_t, Failure> Writer::add_sensor(std::string_view name, std::string_view driver,
                                                 std::string_view options) {
  const auto series = series_named(name);
  if (!series) return series.error();
  insert_sensor_.bind(1, session_);
  insert_sensor_.bind(2, *series);
  insert_sensor_.bind(3, driver);
  insert_sensor_.bind(4, options);
  if (const auto done = write(insert_sensor_); !done) return done.error();
  const std::int64_t sensor = database_.last_id();
  if (const auto done = prepare_insert(sensor, *series); !done) return done.error();
  return sensor;
}

/// The series of that name, which is made if there is none.
Result<std::int64_t, Failure> Writer::series_named(std::string_view name) {
  auto find = database_.prepare("SELECT id FROM series WHERE name = ?1");
  if (!find) return undo().error();
  find->bind(1, name);
  const auto found = find->step();
  if (found == sqlite::Statement::Step::kFailed) return undo().error();
  if (found == sqlite::Statement::Step::kRow) return find->integer(0);

  const auto count = database_.integer("SELECT count(*) FROM series");
  if (!count) return undo().error();
  const std::int64_t series = *count + 1;
  if (series > static_cast<std::int64_t>(kMaxSeries)) {
    return Failure{database_.file().string() + ": has readings of " + std::to_string(kMaxSeries) +
                   " sensors, the maximum of one recording; choose another file"};
  }
  auto insert = database_.prepare("INSERT INTO series (id, name) VALUES (?1, ?2)");
  if (!insert) return undo().error();
  insert->bind(1, series);
  insert->bind(2, name);
  if (const auto done = write(*insert); !done) return done.error();
  if (const auto done = make_series(series); !done) return done.error();
  return series;
}

Result<void, Failure> Writer::make_series(std::int64_t series) {
  const std::string create = "CREATE TABLE reading_" + std::to_string(series) + " " + std::string(kSeriesColumns);
  if (!database_.run(create.c_str())) return undo();
  if (!database_.run(view_of(series).c_str())) return undo();
  return {};
}

Result<void, Failure> Writer::prepare_insert(std::int64_t sensor, std::int64_t series) {
  // Of two at one nanosecond the later one is moved to the next that is free.
  const std::string table = "reading_" + std::to_string(series);
  auto insert = database_.prepare("INSERT INTO " + table +
                                  " (time_ns, clock_ns, speed_m_s, direction_deg, gust_m_s, quality) "
                                  "VALUES (?1, ?2, ?3, ?4, ?5, ?6) ON CONFLICT DO NOTHING");
  if (!insert) return undo();
  insert_reading_[sensor] = {.statement = std::move(*insert), .batch = std::nullopt, .series = series};
  return {};
}

Result<void, Failure> Writer::append(std::int64_t sensor, const wind::Reading& reading) {
  const auto insert = insert_reading_.find(sensor);
  if (insert == insert_reading_.end() || !is_recordable(reading)) {
    return Failure{database_.file().string() + ": this reading has impossible values and cannot be recorded"};
  }
  const Nanoseconds into_session = std::max(reading.time.mono - started_.mono, Nanoseconds{0});
  Insert& into = insert->second;
  into.statement.bind(3, reading.speed_m_s);
  into.statement.bind(4, reading.direction_deg);
  into.statement.bind(5, reading.gust_m_s);
  into.statement.bind(6, static_cast<std::int64_t>(reading.quality));
  std::int64_t since_ns = into_session.count();
  for (int tries = 0;; ++tries) {
    if (since_ns == into.last_since_ns || tries == kMaxTries) since_ns = std::max(since_ns, into.last_since_ns) + 1;
    const auto clock_ns = clock_ns_of(reading, since_ns);
    if (!clock_ns) {
      return Failure{database_.file().string() + ": this reading has impossible values and cannot be recorded"};
    }
    into.statement.bind(1, begin_ns_ + since_ns);
    into.statement.bind(2, *clock_ns);
    if (auto done = write(into.statement); !done) return done;
    if (database_.changed_rows() > 0) break;
    ++since_ns;
  }
  into.last_since_ns = std::max(into.last_since_ns, since_ns);
  count(into, reading, since_ns);
  return {};
}

/// By how much the reading's clock differs from the recording's time line; nullopt if its time cannot be.
std::optional<std::int64_t> Writer::clock_ns_of(const wind::Reading& reading, std::int64_t since_ns) const {
  std::int64_t clock_ns = 0;
  if (since_ns >= kMaxTime_ns - begin_ns_ ||
      __builtin_sub_overflow(nanoseconds(reading.time.utc), nanoseconds(started_.utc), &clock_ns) ||
      __builtin_sub_overflow(clock_ns, since_ns, &clock_ns) || clock_ns < -kMaxTime_ns || clock_ns > kMaxTime_ns) {
    return std::nullopt;
  }
  return clock_ns;
}

void Writer::count(const Insert& insert, const wind::Reading& reading, std::int64_t since_ns) {
  if (!counts_) return;
  wind::Reading stored = reading;
  stored.time.mono = started_.mono + Nanoseconds(since_ns);
  (*counts_)[insert.series].add(stored);
}

Result<void, Failure> Writer::append(std::int64_t sensor, std::span<const wind::Reading> readings) {
  while (!readings.empty()) {
    const auto insert = insert_reading_.find(sensor);
    if (insert != insert_reading_.end() && readings.size() >= kBatch &&
        fits_batch(insert->second, readings.first(kBatch))) {
      if (auto done = append_batch(insert->second, readings.first(kBatch)); !done) return done;
      readings = readings.subspan(kBatch);
    } else {
      if (auto done = append(sensor, readings.front()); !done) return done;
      readings = readings.subspan(1);
    }
  }
  return {};
}

/// Returns true if each is certain to have a time that is free: later than all of its series.
bool Writer::fits_batch(const Insert& insert, std::span<const wind::Reading> readings) const {
  const auto writers =
      std::ranges::count_if(insert_reading_, [&](const auto& other) { return other.second.series == insert.series; });
  std::int64_t last_since_ns = insert.last_since_ns;
  return writers == 1 && std::ranges::all_of(readings, [&](const wind::Reading& reading) {
           const std::int64_t since_ns = (reading.time.mono - started_.mono).count();
           const bool fits = is_recordable(reading) && since_ns > last_since_ns && clock_ns_of(reading, since_ns);
           last_since_ns = since_ns;
           return fits;
         });
}

Result<void, Failure> Writer::append_batch(Insert& insert, std::span<const wind::Reading> readings) {
  if (!insert.batch) {
    std::string sql = "INSERT INTO reading_" + std::to_string(insert.series) +
                      " (time_ns, clock_ns, speed_m_s, direction_deg, gust_m_s, quality) VALUES ";
    for (std::size_t i = 0; i < kBatch; ++i) sql += i == 0 ? "(?, ?, ?, ?, ?, ?)" : ", (?, ?, ?, ?, ?, ?)";
    auto prepared = database_.prepare(sql);
    if (!prepared) return undo();
    insert.batch = std::move(*prepared);
  }
  int position = 0;
  for (const wind::Reading& reading : readings) {
    const std::int64_t since_ns = (reading.time.mono - started_.mono).count();
    insert.batch->bind(++position, begin_ns_ + since_ns);
    insert.batch->bind(++position, *clock_ns_of(reading, since_ns));
    insert.batch->bind(++position, reading.speed_m_s);
    insert.batch->bind(++position, reading.direction_deg);
    insert.batch->bind(++position, reading.gust_m_s);
    insert.batch->bind(++position, static_cast<std::int64_t>(reading.quality));
  }
  if (auto done = write(*insert.batch); !done) return done;
  for (const wind::Reading& reading : readings) {
    const std::int64_t since_ns = (reading.time.mono - started_.mono).count();
    insert.last_since_ns = since_ns;
    count(insert, reading, since_ns);
  }
  return {};
}

Result<bool, Failure> Writer::append(std::int64_t sensor, const wind::StationQuantities& quantities) {
  const auto reading = insert_reading_.find(sensor);
  const auto plausible = wind::plausible_part(quantities);
  wind::Reading at_that_time;
  at_that_time.time = quantities.time;
  if (reading == insert_reading_.end() || !plausible || !is_recordable(at_that_time)) return false;

  const Nanoseconds into_session = std::max(quantities.time.mono - started_.mono, Nanoseconds{0});
  const Nanoseconds second = std::chrono::floor<std::chrono::seconds>(into_session);
  std::int64_t clock_ns = 0;
  if (second.count() >= kMaxTime_ns - begin_ns_ ||
      __builtin_sub_overflow(nanoseconds(quantities.time.utc), nanoseconds(started_.utc), &clock_ns) ||
      __builtin_sub_overflow(clock_ns, into_session.count(), &clock_ns) || clock_ns < -kMaxTime_ns ||
      clock_ns > kMaxTime_ns) {
    return false;
  }

  if (auto begun = begin_transaction(); !begun) return begun.error();
  bool is_added = prepare_quantities();
  if (is_added) {
    sqlite::Statement& insert = *insert_quantities_;
    insert.bind(1, begin_ns_ + second.count());
    insert.bind(2, reading->second.series);
    insert.bind(3, clock_ns);
    int position = 4;
    for (const wind::StationQuantity& each : wind::kStationQuantities)
      insert.bind(position++, (*plausible).*each.value);
    is_added = insert.step() == sqlite::Statement::Step::kDone;
  }
  if (is_added) {
    insert_quantities_->reset();
    return true;
  }
  // Readings must not suffer from a table that is damaged. If the disk is the cause, SQLite reports it, or rolls back.
  const int code = database_.error_code();
  const Failure failure = database_.failure();
  insert_quantities_.reset();
  if (database_.in_transaction() && code != SQLITE_FULL && code != SQLITE_IOERR) return false;
  roll_back();
  return failure;
}

/// Returns false if the file has something else of that name.
bool Writer::prepare_quantities() {
  if (insert_quantities_) return true;
  std::string create = "CREATE TABLE IF NOT EXISTS " + std::string(kQuantityTable) + " " + std::string(kQuantityKeys);
  std::string columns;
  std::string values;
  std::string merged;
  int position = 4;
  for (const wind::StationQuantity& each : wind::kStationQuantities) {
    const std::string name(each.name);
    create.append("\n  ").append(name).append(" REAL,");
    columns.append(", ").append(name);
    values.append(", ?").append(std::to_string(position++));
    merged.append(merged.empty() ? "" : ", ").append(name);
    merged.append(" = coalesce(excluded.").append(name).append(", ").append(name).append(")");
  }
  create.append(kQuantityPrimaryKey);
  if (!database_.run(create.c_str())) return false;
  auto insert =
      database_.prepare("INSERT INTO " + std::string(kQuantityTable) + " (time_ns, series, clock_ns" + columns +
                        ") VALUES (?1, ?2, ?3" + values + ") ON CONFLICT (time_ns, series) DO UPDATE SET " + merged);
  if (!insert) return false;
  insert_quantities_ = std::move(*insert);
  return true;
}

Result<std::optional<UtcTime>, Failure> Writer::began() {
  const auto series = database_.integer("SELECT count(*) FROM series");
  if (!series) return series.error();
  std::int64_t has_readings = 0;
  for (std::int64_t each = 1; each <= *series && has_readings == 0; ++each) {
    const auto found = database_.integer("SELECT EXISTS (SELECT 1 FROM reading_" + std::to_string(each) + ")");
    if (!found) return found.error();
    has_readings = *found;
  }
  if (has_readings == 0 && !last_quantities_ns()) return std::optional<UtcTime>{};
  const auto utc_ns = database_.integer("SELECT started_utc_ns FROM session ORDER BY begin_ns LIMIT 1");
  if (!utc_ns) return utc_ns.error();
  return std::optional(UtcTime(Nanoseconds(*utc_ns)));
}

Result<void, Failure> Writer::commit() {
  if (!database_.in_transaction()) return {};
  if (!database_.run("COMMIT")) return undo();
  return {};
}

Result<void, Failure> Writer::checkpoint() {
  return database_.run("PRAGMA wal_checkpoint(PASSIVE)");
}

Result<void, Failure> Writer::close() {
  const auto committed = commit();
  // Without its counts the recording is complete all the same.
  if (committed && write_counts()) static_cast<void>(commit());

  // Back into one file. A reader that has it open prevents that; what was committed is safe either way.
  database_.set_busy_timeout(kCloseTimeout_ms);
  const auto tidied = database_.run("PRAGMA wal_checkpoint(TRUNCATE); PRAGMA journal_mode = DELETE");
  const bool is_read_by_others =
      !tidied && (database_.error_code() == SQLITE_BUSY || database_.error_code() == SQLITE_LOCKED);
  release();
  return committed && !is_read_by_others ? tidied : committed;
}

void Writer::release() {
  insert_session_ = {};
  insert_sensor_ = {};
  insert_reading_.clear();
  insert_quantities_.reset();
  database_.close();
}

Result<void, Failure> Writer::begin_transaction() {
  if (database_.in_transaction()) return {};
  return database_.run("BEGIN IMMEDIATE");
}

/// Runs an INSERT, in a transaction.
Result<void, Failure> Writer::write(sqlite::Statement& statement) {
  if (auto begun = begin_transaction(); !begun) return begun;
  if (statement.step() != sqlite::Statement::Step::kDone) {
    auto undone = undo();
    statement.reset();
    return undone;
  }
  statement.reset();
  return {};
}

/// Rolls back to the last commit; returns the failure that led to it.
Result<void, Failure> Writer::undo() {
  Failure failure = database_.failure();
  insert_quantities_.reset();  // their table may be taken back, too
  roll_back();
  return failure;
}

void Writer::roll_back() {
  counts_.reset();
  // SQLite rolls back by itself after some errors.
  if (database_.in_transaction()) static_cast<void>(database_.run("ROLLBACK"));
}

}  // namespace yuragi::drivers::windlog
