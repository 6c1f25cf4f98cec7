#include "daemon/history/means_file.hpp"

#include <string_view>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

namespace yuragi::daemon::history {
namespace {

using drivers::windlog::sqlite::Access;
using drivers::windlog::sqlite::Database;
using drivers::windlog::sqlite::Statement;
using Row = Statement::Step;

constexpr std::int64_t kMeansApplicationId = 0x59724d6e;  // "YrMn"
constexpr std::int64_t kMeansVersion = 1;

constexpr const char* kMeansSchema = R"sql(
CREATE TABLE sensor (
  id   INTEGER PRIMARY KEY,
  name TEXT NOT NULL UNIQUE
) STRICT;
CREATE TABLE step (  -- half an hour of a sensor's readings, before calibration
  sensor    INTEGER NOT NULL,
  begin_s   INTEGER NOT NULL,  -- since 1970-01-01T00:00:00Z
  readings  INTEGER NOT NULL,
  sum_m_s   REAL NOT NULL,
  min_m_s   REAL NOT NULL,
  max_m_s   REAL NOT NULL,
  east_m_s  REAL NOT NULL,     -- sums of the vectors, toward which the wind blows
  north_m_s REAL NOT NULL,
  PRIMARY KEY (sensor, begin_s)
) STRICT, WITHOUT ROWID;
CREATE TABLE place (  -- up to where a file of the recording was read
  recording_file INTEGER NOT NULL,  -- the moment of its first reading, ns since 1970
  sensor         TEXT NOT NULL,
  read_to_ns     INTEGER NOT NULL,  -- log time in that file; -1: nothing yet
  PRIMARY KEY (recording_file, sensor)
) STRICT, WITHOUT ROWID;
CREATE TABLE completed (  -- files that were read in full
  name  TEXT PRIMARY KEY,
  bytes INTEGER NOT NULL
) STRICT, WITHOUT ROWID;
)sql";

/// With the mode of a new recording. A file that exists is not opened: closing it would release SQLite's locks on it.
void create_if_missing(const std::filesystem::path& file) {
  constexpr mode_t kMode = 0640;
  const int descriptor = ::open(file.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, kMode);
  if (descriptor >= 0) ::close(descriptor);
}

/// Runs a statement whose parameters are bound, and resets it.
Result<void, Failure> carry_out(const Database& database, Statement& statement) {
  const Row row = statement.step();
  statement.reset();
  if (row == Row::kFailed) return database.failure();
  return {};
}

/// Runs `change` in a transaction, which is rolled back if it fails.
template <class Change>
Result<void, Failure> in_transaction(Database& database, Change change) {
  if (auto begun = database.run("BEGIN IMMEDIATE"); !begun) return begun;
  Result<void, Failure> done = change();
  if (done) done = database.run("COMMIT");
  if (!done && database.in_transaction()) static_cast<void>(database.run("ROLLBACK"));
  return done;
}

Step step_of_columns(const Statement& row, int first) {
  return {.readings = static_cast<std::uint64_t>(row.integer(first)),
          .sum_m_s = row.number(first + 1),
          .min_m_s = row.number(first + 2),
          .max_m_s = row.number(first + 3),
          .vector_sum_m_s = {row.number(first + 4), row.number(first + 5)}};
}

}  // namespace

std::filesystem::path means_file_of(const std::filesystem::path& recording) {
  return recording.string() + "-means";
}

void MeansFile::remove(const std::filesystem::path& file) {
  std::error_code stays;
  std::filesystem::remove(file.string() + "-journal", stays);
  std::filesystem::remove(file, stays);
}

Result<MeansFile, Failure> MeansFile::open(const std::filesystem::path& file, const std::stop_token& stop) {
  create_if_missing(file);
  auto opened = Database::open(file, Access::kReadWrite);
  if (!opened) return opened.error();
  MeansFile means(std::move(*opened));
  Database& database = means.database_;
  database.set_busy_timeout(drivers::windlog::sqlite::kBusyTimeout_ms);
  database.end_on(stop);
  const auto objects = database.integer("SELECT count(*) FROM sqlite_schema");
  if (!objects) return objects.error();
  if (*objects == 0) {
    const std::string create = "PRAGMA application_id = " + std::to_string(kMeansApplicationId) +
                               "; PRAGMA user_version = " + std::to_string(kMeansVersion) + ";" + kMeansSchema;
    const auto created = in_transaction(database, [&] { return database.run(create.c_str()); });
    if (!created) return created.error();
  }
  const auto application = database.integer("PRAGMA application_id");
  if (!application) return application.error();
  const auto version = database.integer("PRAGMA user_version");
  if (!version) return version.error();
  if (*application != kMeansApplicationId || *version != kMeansVersion)
    return Failure{file.string() + ": has no means of this version", FailureKind::kBadData};
  return means;
}

Result<std::optional<Nanoseconds>, Failure> MeansFile::read_to(const ReadPlace& place) {
  auto select = database_.prepare("SELECT read_to_ns FROM place WHERE recording_file = ?1 AND sensor = ?2");
  if (!select) return select.error();
  select->bind(1, place.recording_file);
  select->bind(2, std::string_view(place.sensor));
  const Row row = select->step();
  if (row == Row::kFailed) return database_.failure();
  if (row == Row::kDone || select->integer(0) < 0) return std::optional<Nanoseconds>{};
  return std::optional(Nanoseconds(select->integer(0)));
}

Result<void, Failure> MeansFile::add(const ReadPlace& place, const std::optional<Nanoseconds>& before,
                                     Nanoseconds read_to, const std::map<std::int64_t, Step>& steps) {
  return in_transaction(database_, [&]() -> Result<void, Failure> {
    if (auto moved = move_place(place, before, read_to); !moved) return moved;
    return add_steps(place.sensor, steps);
  });
}

Result<void, Failure> MeansFile::move_place(const ReadPlace& place, const std::optional<Nanoseconds>& before,
                                            Nanoseconds read_to) {
  auto begin = database_.prepare("INSERT OR IGNORE INTO place VALUES (?1, ?2, -1)");
  if (!begin) return begin.error();
  begin->bind(1, place.recording_file);
  begin->bind(2, std::string_view(place.sensor));
  if (auto done = carry_out(database_, *begin); !done) return done;
  auto move = database_.prepare(
      "UPDATE place SET read_to_ns = ?3 WHERE recording_file = ?1 AND sensor = ?2 AND read_to_ns = ?4");
  if (!move) return move.error();
  move->bind(1, place.recording_file);
  move->bind(2, std::string_view(place.sensor));
  move->bind(3, static_cast<std::int64_t>(read_to.count()));
  move->bind(4, before ? static_cast<std::int64_t>(before->count()) : std::int64_t{-1});
  if (auto done = carry_out(database_, *move); !done) return done;
  if (database_.changed_rows() == 1) return {};
  return Failure{database_.file().string() + ": another program reads the same recording; ask again",
                 FailureKind::kUnavailable};
}

Result<void, Failure> MeansFile::add_steps(const std::string& sensor, const std::map<std::int64_t, Step>& steps) {
  auto name = database_.prepare("INSERT OR IGNORE INTO sensor (name) VALUES (?1)");
  if (!name) return name.error();
  name->bind(1, std::string_view(sensor));
  if (auto done = carry_out(database_, *name); !done) return done;
  auto insert = database_.prepare(
      "INSERT INTO step SELECT id, ?2, ?3, ?4, ?5, ?6, ?7, ?8 FROM sensor WHERE name = ?1 ON CONFLICT DO UPDATE SET "
      "readings = readings + excluded.readings, sum_m_s = sum_m_s + excluded.sum_m_s, "
      "min_m_s = min(min_m_s, excluded.min_m_s), max_m_s = max(max_m_s, excluded.max_m_s), "
      "east_m_s = east_m_s + excluded.east_m_s, north_m_s = north_m_s + excluded.north_m_s");
  if (!insert) return insert.error();
  insert->bind(1, std::string_view(sensor));
  for (const auto& [begin_s, step] : steps) {
    insert->bind(2, begin_s);
    insert->bind(3, static_cast<std::int64_t>(step.readings));
    insert->bind(4, step.sum_m_s);
    insert->bind(5, step.min_m_s);
    insert->bind(6, step.max_m_s);
    insert->bind(7, step.vector_sum_m_s.u_m_s);
    insert->bind(8, step.vector_sum_m_s.v_m_s);
    if (auto done = carry_out(database_, *insert); !done) return done;
  }
  return {};
}

Result<bool, Failure> MeansFile::has_all_of(const std::string& file_name, std::uint64_t bytes) {
  auto select = database_.prepare("SELECT 1 FROM completed WHERE name = ?1 AND bytes = ?2");
  if (!select) return select.error();
  select->bind(1, std::string_view(file_name));
  select->bind(2, static_cast<std::int64_t>(bytes));
  const Row row = select->step();
  if (row == Row::kFailed) return database_.failure();
  return row == Row::kRow;
}

Result<void, Failure> MeansFile::note_all_of(const std::string& file_name, std::uint64_t bytes) {
  auto insert = database_.prepare("INSERT OR REPLACE INTO completed VALUES (?1, ?2)");
  if (!insert) return insert.error();
  insert->bind(1, std::string_view(file_name));
  insert->bind(2, static_cast<std::int64_t>(bytes));
  return carry_out(database_, *insert);
}

Result<void, Failure> MeansFile::each_step(
    std::int64_t begin_s, std::int64_t step_s, std::int64_t step_count,
    const std::function<void(const std::string& sensor, std::int64_t index, const Step& step)>& use) {
  auto select = database_.prepare(
      "SELECT name, (begin_s - ?1) / ?2 AS number, sum(readings), sum(sum_m_s), min(min_m_s), max(max_m_s), "
      "sum(east_m_s), sum(north_m_s) FROM step JOIN sensor ON sensor.id = step.sensor "
      "WHERE begin_s >= ?1 AND begin_s < ?1 + ?2 * ?3 GROUP BY sensor.id, number ORDER BY sensor.id, number");
  if (!select) return select.error();
  select->bind(1, begin_s);
  select->bind(2, step_s);
  select->bind(3, step_count);
  Row row = select->step();
  for (; row == Row::kRow; row = select->step()) use(select->text(0), select->integer(1), step_of_columns(*select, 2));
  if (row == Row::kFailed) return database_.failure();
  return {};
}

}  // namespace yuragi::daemon::history
