#include "drivers/windlog/shared_table.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

#include "drivers/windlog/block_rows.hpp"
#include "drivers/windlog/contents.hpp"
#include "drivers/windlog/format.hpp"
#include "drivers/windlog/reading_columns.hpp"

namespace yuragi::drivers::windlog {
namespace {

using sqlite::Statement;

MonoTime mono_time(std::int64_t ns) {
  return MonoTime(Nanoseconds(ns));
}
UtcTime utc_time(std::int64_t ns) {
  return UtcTime(Nanoseconds(ns));
}

/// The time of a session's first or last reading.
Result<std::optional<Instant>, Failure> edge_of(sqlite::Database& database, std::int64_t session,
                                                std::string_view order) {
  auto edge = database.prepare(
      "SELECT utc_ns, mono_ns FROM reading WHERE session = ?1 AND mono_ns BETWEEN 0 AND ?2 "
      "AND utc_ns BETWEEN -?2 AND ?2 ORDER BY mono_ns " +
      std::string(order) + ", rowid " + std::string(order) + " LIMIT 1");
  if (!edge) return edge.error();
  edge->bind(1, session);
  edge->bind(2, kMaxTime_ns);
  switch (edge->step()) {
    case Statement::Step::kRow:
      return Instant{mono_time(edge->integer(1)), utc_time(edge->integer(0))};
    case Statement::Step::kDone:
      return std::optional<Instant>{};
    case Statement::Step::kFailed:
      break;
  }
  return database.failure();
}

class SharedTable final : public StoredReadings {
 public:
  explicit SharedTable(sqlite::Database& database) : database_(database) {}

  Result<void, Failure> load() {
    if (auto loaded = load_sessions(); !loaded) return loaded;
    return load_sensors();
  }

  Result<std::vector<std::unique_ptr<ReadingBlocks>>, Failure> blocks(
      const std::vector<bool>& of_sensors) const override;
  Result<std::string, Failure> configuration(std::int64_t session) const override {
    return configuration_of(database_, session);
  }
  Result<std::optional<Nanoseconds>, Failure> log_time_of(UtcTime moment) const override;
  Result<std::optional<Nanoseconds>, Failure> last_log_time(const std::vector<bool>& of_sensors) const override;

 private:
  Result<void, Failure> load_sessions();
  Result<void, Failure> load_sensors();

  sqlite::Database& database_;
};

Result<void, Failure> SharedTable::load_sessions() {
  auto rows = database_.prepare("SELECT id, substr(software, 1, 256) FROM session ORDER BY id");
  if (!rows) return rows.error();
  Statement::Step step = rows->step();
  for (; step == Statement::Step::kRow && sessions.size() < kMaxSessions; step = rows->step()) {
    LoggedSession session;
    session.id = rows->integer(0);
    session.software = rows->text(1);
    const auto first = edge_of(database_, session.id, "ASC");
    if (!first) return first.error();
    const auto last = edge_of(database_, session.id, "DESC");
    if (!last) return last.error();
    if (!*first || !*last) continue;

    // A clock that was set back between two sessions makes no gap; sums that would not fit make no recording.
    session.first = **first;
    session.last = **last;
    if (!sessions.empty()) {
      const Nanoseconds gap = session.first.utc - sessions.back().last.utc;
      session.log_begin = sessions.back().log_end() + std::max(gap, Nanoseconds{0});
    }
    const std::int64_t span_ns = (session.last.mono - session.first.mono).count();
    if (span_ns < 0 || session.log_begin.count() > kMaxTime_ns - span_ns) {
      return impossible_times(database_, session.id);
    }
    sessions.push_back(std::move(session));
  }
  return end_of_list(database_, step, "sessions");
}

Result<void, Failure> SharedTable::load_sensors() {
  auto rows = database_.prepare(
      "SELECT id, session, substr(name, 1, 256), substr(driver, 1, 256), substr(options, 1, 4096) FROM sensor "
      "ORDER BY id");
  if (!rows) return rows.error();
  Statement::Step step = rows->step();
  for (; step == Statement::Step::kRow && sensors.size() < kMaxSensorsOfRecording; step = rows->step()) {
    sensors.push_back({rows->integer(0), rows->integer(1), rows->text(2), rows->text(3), rows->text(4)});
  }
  if (auto read = end_of_list(database_, step, "sensors"); !read) return read;

  // They are looked up by id, because a damaged file can have them in any order.
  std::stable_sort(sensors.begin(), sensors.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  return {};
}

/// All sessions one after the other, each by the monotonic clock.
class SharedTableBlocks final : public ReadingBlocks {
 public:
  SharedTableBlocks(const sqlite::Database& database, const StoredReadings& contents, std::vector<bool> of_sensors,
                    Statement select)
      : database_(database), contents_(contents), of_sensors_(std::move(of_sensors)), select_(std::move(select)) {
    seek(Nanoseconds{0});
  }

  void seek(Nanoseconds log_time) override {
    if (contents_.sessions.empty()) return;
    std::size_t index = 0;
    while (index + 1 < contents_.sessions.size() && contents_.sessions[index].log_end() < log_time) ++index;
    begin_session(index, log_time - contents_.sessions[index].log_begin);
  }

  Result<void, Failure> read(std::vector<LoggedReading>& block, std::size_t& skipped) override {
    block.clear();
    while (block.empty() && !contents_.sessions.empty()) {
      const auto rows = read_rows(block, skipped);
      if (!rows) return rows.error();
      if (*rows > 0) continue;

      // The session is read. The last one may still grow.
      if (session_index_ + 1 == contents_.sessions.size()) return {};
      begin_session(session_index_ + 1, Nanoseconds{0});
    }
    return {};
  }

 private:
  void begin_session(std::size_t index, Nanoseconds into_session) {
    session_index_ = index;
    const Nanoseconds offset = std::clamp(into_session, Nanoseconds{0}, Nanoseconds{kMaxTime_ns});
    after_mono_ns_ = (contents_.sessions[index].first.mono + offset).time_since_epoch().count();
    after_row_ = std::numeric_limits<std::int64_t>::min();
  }

  Result<std::int64_t, Failure> read_rows(std::vector<LoggedReading>& block, std::size_t& skipped);
  std::optional<LoggedReading> reading_of_row(const LoggedSession& session) const;

  const sqlite::Database& database_;
  const StoredReadings& contents_;
  std::vector<bool> of_sensors_;
  Statement select_;
  std::size_t session_index_ = 0;
  std::int64_t after_mono_ns_ = 0;
  std::int64_t after_row_ = 0;
};

/// Reads the next rows of the present session; returns their number.
Result<std::int64_t, Failure> SharedTableBlocks::read_rows(std::vector<LoggedReading>& block, std::size_t& skipped) {
  const LoggedSession& session = contents_.sessions[session_index_];
  select_.bind(1, session.id);
  select_.bind(2, after_mono_ns_);
  select_.bind(3, after_row_);
  select_.bind(4, kMaxTime_ns);
  select_.bind(5, kBlockRows);

  std::pair key(after_mono_ns_, after_row_);
  const auto logged_in_row = [&]() -> Result<std::optional<LoggedReading>, Failure> {
    // An order that is not one means a damaged index, which could lead in circles.
    const std::pair next(select_.integer(3), select_.integer(0));
    if (next <= key) {
      return Failure{database_.file().string() + ": its index is damaged; `sqlite3 FILE REINDEX` may repair it",
                     FailureKind::kBadData};
    }
    key = next;
    return reading_of_row(session);
  };
  const auto rows = read_block(database_, select_, of_sensors_, logged_in_row, block, skipped);
  if (rows) std::tie(after_mono_ns_, after_row_) = key;
  return rows;
}

/// The row that the statement stands at, if it can be a reading of a sensor of this session.
std::optional<LoggedReading> SharedTableBlocks::reading_of_row(const LoggedSession& session) const {
  for (const int column : {1, 2, 3}) {
    if (select_.type(column) != SQLITE_INTEGER) return std::nullopt;
  }
  const std::int64_t id = select_.integer(1);
  const auto sensor =
      std::lower_bound(contents_.sensors.begin(), contents_.sensors.end(), id,
                       [](const LoggedSensor& candidate, std::int64_t wanted) { return candidate.id < wanted; });
  if (sensor == contents_.sensors.end() || sensor->id != id || sensor->session != session.id) return std::nullopt;

  const std::int64_t utc_ns = select_.integer(2);
  const std::int64_t mono_ns = select_.integer(3);
  if (utc_ns < -kMaxTime_ns || utc_ns > kMaxTime_ns) return std::nullopt;
  if (mono_ns < session.first.mono.time_since_epoch().count()) return std::nullopt;
  const auto reading = reading_of_columns(select_, 4, {mono_time(mono_ns), utc_time(utc_ns)});
  if (!reading) return std::nullopt;
  return LoggedReading{.log_time = session.log_begin + (mono_time(mono_ns) - session.first.mono),
                       .sensor = static_cast<std::size_t>(sensor - contents_.sensors.begin()),
                       .reading = *reading};
}

Result<std::vector<std::unique_ptr<ReadingBlocks>>, Failure> SharedTable::blocks(
    const std::vector<bool>& of_sensors) const {
  auto select = database_.prepare(
      "SELECT rowid, sensor, utc_ns, mono_ns, speed_m_s, direction_deg, gust_m_s, quality FROM reading "
      "WHERE session = ?1 AND (mono_ns, rowid) > (?2, ?3) AND mono_ns <= ?4 ORDER BY mono_ns, rowid LIMIT ?5");
  if (!select) return select.error();
  std::vector<std::unique_ptr<ReadingBlocks>> all;
  all.push_back(std::make_unique<SharedTableBlocks>(database_, *this, of_sensors, std::move(*select)));
  return all;
}

Result<std::optional<Nanoseconds>, Failure> SharedTable::log_time_of(UtcTime moment) const {
  auto first_after = database_.prepare(
      "SELECT mono_ns FROM reading WHERE session = ?1 AND mono_ns BETWEEN ?2 AND ?3 AND utc_ns BETWEEN ?4 AND ?3 "
      "ORDER BY mono_ns LIMIT 1");
  if (!first_after) return first_after.error();
  for (const LoggedSession& session : sessions) {
    if (session.last.utc < moment) continue;
    first_after->bind(1, session.id);
    first_after->bind(2, session.first.mono.time_since_epoch().count());
    first_after->bind(3, kMaxTime_ns);
    first_after->bind(4, moment.time_since_epoch().count());
    const Statement::Step step = first_after->step();
    if (step == Statement::Step::kFailed) return database_.failure();
    if (step == Statement::Step::kRow) {
      return std::optional(session.log_begin + (mono_time(first_after->integer(0)) - session.first.mono));
    }
    first_after->reset();
  }
  return std::optional<Nanoseconds>{};
}

Result<std::optional<Nanoseconds>, Failure> SharedTable::last_log_time(const std::vector<bool>& of_sensors) const {
  auto backward = database_.prepare(
      "SELECT mono_ns FROM reading WHERE session = ?1 AND sensor = ?2 AND mono_ns BETWEEN ?3 AND ?4 "
      "ORDER BY mono_ns DESC LIMIT 1");
  if (!backward) return backward.error();
  for (std::size_t back = 0; back < sessions.size(); ++back) {
    const LoggedSession& session = sessions[sessions.size() - 1 - back];
    std::optional<Nanoseconds> last;
    for (std::size_t index = 0; index < sensors.size(); ++index) {
      if (!of_sensors[index] || sensors[index].session != session.id) continue;
      backward->bind(1, session.id);
      backward->bind(2, sensors[index].id);
      backward->bind(3, session.first.mono.time_since_epoch().count());
      backward->bind(4, session.last.mono.time_since_epoch().count());
      const Statement::Step step = backward->step();
      if (step == Statement::Step::kFailed) return database_.failure();
      if (step == Statement::Step::kRow) {
        const Nanoseconds found = session.log_begin + (mono_time(backward->integer(0)) - session.first.mono);
        last = std::max(last.value_or(found), found);
      }
      backward->reset();
    }
    if (last) return last;
  }
  return std::optional<Nanoseconds>{};
}

}  // namespace

Result<std::unique_ptr<StoredReadings>, Failure> open_shared_table(sqlite::Database& database) {
  auto table = std::make_unique<SharedTable>(database);
  if (const auto loaded = table->load(); !loaded) return loaded.error();
  return std::unique_ptr<StoredReadings>(std::move(table));
}

}  // namespace yuragi::drivers::windlog
