#include "drivers/windlog/series_tables.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "drivers/windlog/block_rows.hpp"
#include "drivers/windlog/contents.hpp"
#include "drivers/windlog/format.hpp"
#include "drivers/windlog/reading_columns.hpp"

namespace yuragi::drivers::windlog {
namespace {

using sqlite::Statement;

/// A session on the recording's time line, whether it has readings or not.
struct Start {
  std::int64_t session = 0;
  std::int64_t begin_ns = 0;
  std::int64_t end_ns = kMaxTime_ns;  ///< the next one's begin
  Instant started;
  std::string software;
};

/// A place on the time line, and what the clocks of the recording machine showed there.
struct Place {
  std::int64_t time_ns = 0;
  Instant clocks;
};

/// Returns what the clocks showed at a time of a session; nullopt if that is impossible.
std::optional<Instant> clocks_at(const Start& start, std::int64_t time_ns, std::int64_t clock_ns) {
  const Nanoseconds since_start(time_ns - start.begin_ns);
  const std::int64_t mono_ns = (start.started.mono + since_start).time_since_epoch().count();
  if (mono_ns < 0 || mono_ns > kMaxTime_ns || clock_ns < -kMaxTime_ns || clock_ns > kMaxTime_ns) return std::nullopt;
  std::int64_t utc_ns = 0;
  if (__builtin_add_overflow(start.started.utc.time_since_epoch().count(), since_start.count(), &utc_ns) ||
      __builtin_add_overflow(utc_ns, clock_ns, &utc_ns) || utc_ns < -kMaxTime_ns || utc_ns > kMaxTime_ns) {
    return std::nullopt;
  }
  return Instant{MonoTime(Nanoseconds(mono_ns)), UtcTime(Nanoseconds(utc_ns))};
}

std::string table_of(std::int64_t series) {
  return "reading_" + std::to_string(series);
}

class SeriesTables final : public StoredReadings {
 public:
  explicit SeriesTables(sqlite::Database& database) : database_(database) {}

  Result<void, Failure> load() {
    if (auto loaded = load_starts(); !loaded) return loaded;
    if (auto loaded = load_sensors(); !loaded) return loaded;
    if (auto loaded = load_sessions(); !loaded) return loaded;
    if (sessions.empty() && !starts_.empty() && has_quantities()) begun_without_readings = starts_.front().started.utc;
    return {};
  }

  Result<std::vector<std::unique_ptr<ReadingBlocks>>, Failure> blocks(
      const std::vector<bool>& of_sensors) const override;
  Result<std::string, Failure> configuration(std::int64_t session) const override {
    return configuration_of(database_, session);
  }
  Result<std::optional<Nanoseconds>, Failure> log_time_of(UtcTime moment) const override;
  Result<std::optional<Nanoseconds>, Failure> last_log_time(const std::vector<bool>& of_sensors) const override;

  Result<std::size_t, Failure> each_quantities(Nanoseconds from, Nanoseconds to,
                                               const UseQuantities& use) const override;

  /// Returns the session at a time; nullptr before the first.
  const Start* start_at(std::int64_t time_ns) const {
    const auto after = std::ranges::upper_bound(starts_, time_ns, {}, &Start::begin_ns);
    return after == starts_.begin() ? nullptr : &*std::prev(after);
  }

  /// The index of a session's sensor of that series.
  std::optional<std::size_t> sensor_of(std::int64_t session, std::int64_t series) const {
    const auto found = sensor_of_.find({session, series});
    if (found == sensor_of_.end()) return std::nullopt;
    return found->second;
  }

  Nanoseconds log_time(std::int64_t time_ns) const { return Nanoseconds(time_ns - zero_ns_); }

  /// The place on the time line, within what a time can be.
  std::int64_t time_ns(Nanoseconds log_time) const {
    const std::int64_t longest_ns = kMaxTime_ns - zero_ns_;
    return zero_ns_ + std::clamp<std::int64_t>(log_time.count(), -zero_ns_, longest_ns);
  }

  std::int64_t last_begin_ns() const { return starts_.empty() ? -1 : starts_.back().begin_ns; }

 private:
  Result<void, Failure> load_starts();
  Result<void, Failure> load_sensors();
  Result<void, Failure> load_sessions();
  bool has_quantities() const;
  Result<std::optional<Place>, Failure> edge_of(const Start& start, bool is_last) const;
  Result<std::optional<Place>, Failure> edge_of(const Start& start, std::int64_t series, bool is_last) const;
  Result<std::optional<std::int64_t>, Failure> first_after(const Start& start, std::int64_t series,
                                                           UtcTime moment) const;
  std::vector<std::int64_t> series_of(std::int64_t session) const;

  sqlite::Database& database_;
  std::vector<Start> starts_;                                               ///< by time
  std::vector<std::int64_t> series_of_;                                     ///< of each of `sensors`
  std::map<std::pair<std::int64_t, std::int64_t>, std::size_t> sensor_of_;  ///< by session and series
  std::int64_t zero_ns_ = 0;                                                ///< where log time begins
};

Result<void, Failure> SeriesTables::load_starts() {
  auto rows = database_.prepare(
      "SELECT id, begin_ns, started_utc_ns, started_mono_ns, substr(software, 1, 256) FROM session ORDER BY begin_ns");
  if (!rows) return rows.error();
  Statement::Step step = rows->step();
  for (; step == Statement::Step::kRow && starts_.size() < kMaxSessions; step = rows->step()) {
    Start start{.session = rows->integer(0),
                .begin_ns = rows->integer(1),
                .started = {MonoTime(Nanoseconds(rows->integer(3))), UtcTime(Nanoseconds(rows->integer(2)))},
                .software = rows->text(4)};
    const std::int64_t least_ns = starts_.empty() ? 0 : starts_.back().begin_ns + 1;
    const bool can_be = start.begin_ns >= least_ns && start.begin_ns < kMaxTime_ns && rows->integer(3) >= 0 &&
                        rows->integer(3) <= kMaxTime_ns && rows->integer(2) >= -kMaxTime_ns &&
                        rows->integer(2) <= kMaxTime_ns;
    if (!can_be) return impossible_times(database_, start.session);
    if (!starts_.empty()) starts_.back().end_ns = start.begin_ns;
    starts_.push_back(std::move(start));
  }
  return end_of_list(database_, step, "sessions");
}

Result<void, Failure> SeriesTables::load_sensors() {
  auto rows = database_.prepare(
      "SELECT sensor.id, session, series, substr(name, 1, 256), substr(driver, 1, 256), substr(options, 1, 4096) "
      "FROM sensor JOIN series ON series.id = series WHERE series BETWEEN 1 AND ?1 ORDER BY sensor.id");
  if (!rows) return rows.error();
  rows->bind(1, static_cast<std::int64_t>(kMaxSeries));
  Statement::Step step = rows->step();
  for (; step == Statement::Step::kRow && sensors.size() < kMaxSensorsOfRecording; step = rows->step()) {
    if (!sensor_of_.try_emplace({rows->integer(1), rows->integer(2)}, sensors.size()).second) continue;
    series_of_.push_back(rows->integer(2));
    sensors.push_back({rows->integer(0), rows->integer(1), rows->text(3), rows->text(4), rows->text(5)});
  }
  return end_of_list(database_, step, "sensors");
}

std::vector<std::int64_t> SeriesTables::series_of(std::int64_t session) const {
  std::vector<std::int64_t> found;
  const auto from = sensor_of_.lower_bound({session, std::numeric_limits<std::int64_t>::min()});
  for (auto at = from; at != sensor_of_.end() && at->first.first == session; ++at) found.push_back(at->first.second);
  return found;
}

Result<void, Failure> SeriesTables::load_sessions() {
  for (const Start& start : starts_) {
    const auto first = edge_of(start, false);
    if (!first) return first.error();
    const auto last = edge_of(start, true);
    if (!last) return last.error();
    if (!*first || !*last) continue;
    if (sessions.empty()) zero_ns_ = (*first)->time_ns;
    sessions.push_back({.id = start.session,
                        .software = start.software,
                        .first = (*first)->clocks,
                        .last = (*last)->clocks,
                        .log_begin = log_time((*first)->time_ns)});
  }
  return {};
}

/// A session's first or last reading.
Result<std::optional<Place>, Failure> SeriesTables::edge_of(const Start& start, bool is_last) const {
  std::optional<Place> edge;
  for (const std::int64_t series : series_of(start.session)) {
    const auto found = edge_of(start, series, is_last);
    if (!found) return found.error();
    if (*found && (!edge || ((*found)->time_ns > edge->time_ns) == is_last)) edge = *found;
  }
  return edge;
}

Result<std::optional<Place>, Failure> SeriesTables::edge_of(const Start& start, std::int64_t series,
                                                            bool is_last) const {
  auto rows = database_.prepare("SELECT time_ns, clock_ns FROM " + table_of(series) +
                                " WHERE time_ns >= ?1 AND time_ns < ?2 ORDER BY time_ns " + (is_last ? "DESC" : "ASC"));
  if (!rows) return rows.error();
  rows->bind(1, start.begin_ns);
  rows->bind(2, start.end_ns);
  Statement::Step step = rows->step();
  for (; step == Statement::Step::kRow; step = rows->step()) {
    const std::int64_t time_ns = rows->integer(0);
    if (const auto clocks = clocks_at(start, time_ns, rows->integer(1))) return std::optional(Place{time_ns, *clocks});
  }
  if (step == Statement::Step::kFailed) return database_.failure();
  return std::optional<Place>{};
}

/// Returns the quantities in the current row, from column `first` on; nullopt if they are impossible.
std::optional<wind::StationQuantities> quantities_of_columns(const Statement& row, int first, const Instant& time) {
  wind::StationQuantities quantities;
  quantities.time = time;
  int column = first;
  for (const wind::StationQuantity& each : wind::kStationQuantities) {
    if (row.type(column) == SQLITE_FLOAT) quantities.*each.value = row.number(column);
    ++column;
  }
  return wind::plausible_part(quantities);
}

Result<std::size_t, Failure> SeriesTables::each_quantities(Nanoseconds from, Nanoseconds to,
                                                           const UseQuantities& use) const {
  const auto has_table = database_.integer("SELECT count(*) FROM sqlite_schema WHERE type = 'table' AND name = '" +
                                           std::string(kQuantityTable) + "'");
  if (!has_table) return has_table.error();
  std::size_t skipped = 0;
  if (*has_table == 0) return skipped;

  std::string select = "SELECT time_ns, series, clock_ns";
  for (const wind::StationQuantity& each : wind::kStationQuantities) select.append(", ").append(each.name);
  select.append(" FROM ").append(kQuantityTable);
  auto rows = database_.prepare(select + " WHERE time_ns >= ?1 AND time_ns < ?2 ORDER BY time_ns, series");
  if (!rows) return Failure{rows.error().message, FailureKind::kBadData};
  rows->bind(1, from <= Nanoseconds{0} ? std::int64_t{0} : time_ns(from));
  rows->bind(2, time_ns(to));
  std::pair<std::int64_t, std::int64_t> last(-1, 0);
  Statement::Step step = rows->step();
  for (; step == Statement::Step::kRow; step = rows->step()) {
    // An order that is not one means a damaged table, which could lead in circles.
    const std::pair at(rows->integer(0), rows->integer(1));
    if (at <= last) {
      return Failure{database_.file().string() + ": its quantities are not in order; the file is damaged",
                     FailureKind::kBadData};
    }
    last = at;
    const bool has_types = rows->type(1) == SQLITE_INTEGER && rows->type(2) == SQLITE_INTEGER;
    const Start* start = start_at(at.first);
    const auto sensor = !has_types || start == nullptr ? std::nullopt : sensor_of(start->session, at.second);
    const auto clocks = sensor ? clocks_at(*start, at.first, rows->integer(2)) : std::nullopt;
    const auto quantities = clocks ? quantities_of_columns(*rows, 3, *clocks) : std::nullopt;
    if (quantities) {
      use({log_time(at.first), *sensor, *quantities});
    } else {
      ++skipped;
    }
  }
  if (step == Statement::Step::kFailed) return database_.failure();
  return skipped;
}

/// Also returns true on a read error.
bool SeriesTables::has_quantities() const {
  const auto tables = database_.integer("SELECT count(*) FROM sqlite_schema WHERE type = 'table' AND name = '" +
                                        std::string(kQuantityTable) + "'");
  if (!tables || *tables == 0) return false;
  const auto found = database_.integer("SELECT EXISTS (SELECT 1 FROM " + std::string(kQuantityTable) + ")");
  return !found || *found != 0;
}

/// One series, through all sessions.
class SeriesBlocks final : public ReadingBlocks {
 public:
  SeriesBlocks(const sqlite::Database& database, const SeriesTables& contents, std::int64_t series,
               std::vector<bool> of_sensors, Statement select)
      : database_(database),
        contents_(contents),
        series_(series),
        of_sensors_(std::move(of_sensors)),
        select_(std::move(select)) {
    seek(Nanoseconds{0});
  }

  void seek(Nanoseconds log_time) override { after_ns_ = contents_.time_ns(log_time) - 1; }

  Result<void, Failure> read(std::vector<LoggedReading>& block, std::size_t& skipped) override {
    block.clear();
    while (block.empty()) {
      const auto rows = read_rows(block, skipped);
      if (!rows) return rows.error();
      if (*rows == 0) return {};
    }
    return {};
  }

 private:
  Result<std::int64_t, Failure> read_rows(std::vector<LoggedReading>& block, std::size_t& skipped);
  std::optional<LoggedReading> reading_of_row(std::int64_t time_ns) const;

  const sqlite::Database& database_;
  const SeriesTables& contents_;
  std::int64_t series_;
  std::vector<bool> of_sensors_;
  Statement select_;
  std::int64_t after_ns_ = -1;
};

/// Reads the next rows; returns their number.
Result<std::int64_t, Failure> SeriesBlocks::read_rows(std::vector<LoggedReading>& block, std::size_t& skipped) {
  select_.bind(1, after_ns_);
  select_.bind(2, kMaxTime_ns);
  select_.bind(3, contents_.last_begin_ns());
  select_.bind(4, kBlockRows);
  std::int64_t time_ns = after_ns_;
  const auto logged_in_row = [&]() -> Result<std::optional<LoggedReading>, Failure> {
    // An order that is not one means a damaged table, which could lead in circles.
    if (select_.integer(0) <= time_ns) {
      return Failure{database_.file().string() +
                     ": its readings are not in order; the file is damaged; "
                     "`sqlite3 FILE .recover` may save what is left"};
    }
    time_ns = select_.integer(0);
    return reading_of_row(time_ns);
  };
  const auto rows = read_block(database_, select_, of_sensors_, logged_in_row, block, skipped);
  if (rows) after_ns_ = time_ns;
  return rows;
}

/// The row that the statement stands at, if it can be a reading of a sensor of this series.
std::optional<LoggedReading> SeriesBlocks::reading_of_row(std::int64_t time_ns) const {
  const Start* start = contents_.start_at(time_ns);
  const auto sensor = start == nullptr ? std::nullopt : contents_.sensor_of(start->session, series_);
  if (!sensor || select_.type(1) != SQLITE_INTEGER) return std::nullopt;
  const auto clocks = clocks_at(*start, time_ns, select_.integer(1));
  const auto reading = clocks ? reading_of_columns(select_, 2, *clocks) : std::nullopt;
  if (!reading) return std::nullopt;
  return LoggedReading{contents_.log_time(time_ns), *sensor, *reading};
}

Result<std::vector<std::unique_ptr<ReadingBlocks>>, Failure> SeriesTables::blocks(
    const std::vector<bool>& of_sensors) const {
  std::vector<std::int64_t> chosen;
  for (std::size_t sensor = 0; sensor < sensors.size(); ++sensor) {
    if (of_sensors[sensor]) chosen.push_back(series_of_[sensor]);
  }
  std::ranges::sort(chosen);
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());

  std::vector<std::unique_ptr<ReadingBlocks>> all;
  for (const std::int64_t series : chosen) {
    // Up to a session that began after the opening, of which nothing is known here.
    auto select = database_.prepare(
        "SELECT time_ns, clock_ns, speed_m_s, direction_deg, gust_m_s, quality FROM " + table_of(series) +
        " WHERE time_ns > ?1 AND time_ns < (SELECT coalesce(min(begin_ns), ?2) FROM session WHERE begin_ns > ?3) "
        "ORDER BY time_ns LIMIT ?4");
    if (!select) return select.error();
    all.push_back(std::make_unique<SeriesBlocks>(database_, *this, series, of_sensors, std::move(*select)));
  }
  return all;
}

Result<std::optional<Nanoseconds>, Failure> SeriesTables::log_time_of(UtcTime moment) const {
  for (const LoggedSession& session : sessions) {
    if (session.last.utc < moment) continue;
    const auto start = std::ranges::find(starts_, session.id, &Start::session);
    std::optional<std::int64_t> first_ns;
    for (const std::int64_t series : series_of(session.id)) {
      const auto found = first_after(*start, series, moment);
      if (!found) return found.error();
      if (*found) first_ns = std::min(first_ns.value_or(**found), **found);
    }
    if (first_ns) return std::optional(log_time(*first_ns));
  }
  return std::optional<Nanoseconds>{};
}

/// The time of a series' first reading in a session at or after a moment, by bisection; of one of several where the
/// clock was set back across that moment.
Result<std::optional<std::int64_t>, Failure> SeriesTables::first_after(const Start& start, std::int64_t series,
                                                                       UtcTime moment) const {
  const auto last = edge_of(start, series, true);
  if (!last) return last.error();
  if (!*last || (*last)->clocks.utc < moment) return std::optional<std::int64_t>{};
  auto from = database_.prepare("SELECT time_ns, clock_ns FROM " + table_of(series) +
                                " WHERE time_ns >= ?1 AND time_ns <= ?2 ORDER BY time_ns LIMIT 1");
  if (!from) return from.error();

  std::int64_t found_ns = (*last)->time_ns;
  std::int64_t low_ns = start.begin_ns;  // all before it are before the moment
  std::int64_t high_ns = found_ns;       // the first one from here on is not
  while (low_ns < high_ns) {
    const std::int64_t middle_ns = low_ns + (high_ns - low_ns) / 2;
    from->bind(1, middle_ns);
    from->bind(2, found_ns);
    if (from->step() != Statement::Step::kRow) return database_.failure();
    const std::int64_t time_ns = from->integer(0);
    const auto clocks = clocks_at(start, time_ns, from->integer(1));
    from->reset();
    if (clocks && clocks->utc >= moment) {
      found_ns = time_ns;
      high_ns = middle_ns;
    } else {
      low_ns = time_ns + 1;
    }
  }
  return std::optional(found_ns);
}

Result<std::optional<Nanoseconds>, Failure> SeriesTables::last_log_time(const std::vector<bool>& of_sensors) const {
  for (std::size_t back = 0; back < starts_.size(); ++back) {
    const Start& start = starts_[starts_.size() - 1 - back];
    std::optional<Nanoseconds> last;
    for (const std::int64_t series : series_of(start.session)) {
      if (!of_sensors[*sensor_of(start.session, series)]) continue;
      const auto found = edge_of(start, series, true);
      if (!found) return found.error();
      if (*found) last = std::max(last.value_or(log_time((*found)->time_ns)), log_time((*found)->time_ns));
    }
    if (last) return last;
  }
  return std::optional<Nanoseconds>{};
}

}  // namespace

Result<std::unique_ptr<StoredReadings>, Failure> open_series_tables(sqlite::Database& database) {
  auto tables = std::make_unique<SeriesTables>(database);
  if (const auto loaded = tables->load(); !loaded) return loaded.error();
  return std::unique_ptr<StoredReadings>(std::move(tables));
}

}  // namespace yuragi::drivers::windlog
