#include "drivers/windlog/windlog_reader.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <limits>
#include <string_view>
#include <system_error>
#include <utility>

#include "drivers/windlog/format.hpp"

namespace yuragi::drivers::windlog {
namespace {

using sqlite::Statement;

constexpr std::int64_t kBlockRows = 512;
// More than a recorder makes in years; a file with more is no recording.
constexpr std::size_t kMaxSessions = 1'000'000;
constexpr std::size_t kMaxSensors = 1'000'000;

MonoTime mono_time(std::int64_t ns) {
  return MonoTime(Nanoseconds(ns));
}
UtcTime utc_time(std::int64_t ns) {
  return UtcTime(Nanoseconds(ns));
}

std::filesystem::path wal_of(const std::filesystem::path& file) {
  return file.string() + std::string(kWalSuffix);
}

bool is_absent_or_empty(const std::filesystem::path& file) {
  std::error_code error;
  const auto size = std::filesystem::file_size(file, error);
  return error || size == 0;
}

/// What a file is that was given in place of a recording; empty where it begins as a database does, or is empty.
std::string foreign_kind(const std::filesystem::path& file) {
  constexpr std::string_view kMagic = "SQLite format 3";
  std::array<char, 512> block{};
  std::ifstream in(file, std::ios::binary);
  in.read(block.data(), block.size());
  const std::string_view begin(block.data(), static_cast<std::size_t>(in.gcount()));
  if (begin.empty() || begin.starts_with(kMagic)) return "";
  const auto is_control = [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte == 0x7f || (byte < 0x20 && c != '\t' && c != '\r' && c != '\n');
  };
  if (std::ranges::any_of(begin, is_control)) return "is not a Yuragi recording";
  const std::string_view first_line = begin.substr(0, begin.find('\n'));
  if (file.extension() != ".csv" && first_line.find_first_of(",;\t") == std::string_view::npos) {
    return "is a text file, not a Yuragi recording";
  }
  const std::string made = std::filesystem::path(file).replace_extension(".windlog").string();
  return "is a CSV file, not a recording: import it with `yuragi import " + file.string() + " -o " + made + "`";
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

}  // namespace

Result<WindlogReader, Failure> WindlogReader::open(const std::filesystem::path& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status))
    return Failure{file.string() + ": there is no such recording", FailureKind::kNoInput};
  if (!std::filesystem::is_regular_file(status))
    return Failure{file.string() + ": is not a file", FailureKind::kBadData};

  auto reader = open_as(file, sqlite::Access::kReadOnly);
  if (reader) return reader;

  // In a folder where nothing can be created SQLite cannot share the file, but a file that was closed needs no sharing.
  if (is_absent_or_empty(wal_of(file))) {
    if (auto frozen = open_as(file, sqlite::Access::kReadFrozen)) return frozen;
  }
  if (const std::string kind = foreign_kind(file); !kind.empty()) {
    return Failure{file.string() + ": " + kind, FailureKind::kBadData};
  }
  return Failure{reader.error().message, FailureKind::kBadData};
}

Result<WindlogReader, Failure> WindlogReader::open_as(const std::filesystem::path& file, sqlite::Access access) {
  auto database = sqlite::Database::open(file, access);
  if (!database) return database.error();
  WindlogReader reader(std::move(*database));
  reader.database_.set_busy_timeout(sqlite::kBusyTimeout_ms);
  if (const auto done = reader.check_format(); !done) return done.error();
  if (const auto done = reader.load_sessions(); !done) return done.error();
  if (const auto done = reader.load_sensors(); !done) return done.error();

  auto block = reader.database_.prepare(
      "SELECT rowid, sensor, utc_ns, mono_ns, speed_m_s, direction_deg, gust_m_s, quality FROM reading "
      "WHERE session = ?1 AND (mono_ns, rowid) > (?2, ?3) AND mono_ns <= ?4 ORDER BY mono_ns, rowid LIMIT ?5");
  if (!block) return block.error();
  reader.select_block_ = std::move(*block);
  reader.seek(Nanoseconds{0});
  return reader;
}

Result<void, Failure> WindlogReader::check_format() {
  const std::string name = database_.file().string();
  const auto application = database_.integer("PRAGMA application_id");
  if (!application) {
    if (database_.error_code() == SQLITE_CANTOPEN && !is_absent_or_empty(wal_of(database_.file()))) {
      return Failure{name + ": its newest readings are still in " + wal_of(database_.file()).string() +
                     ", which needs a writable folder; copy both files to one"};
    }
    return application.error();
  }
  if (*application != kApplicationId) return Failure{name + ": is not a Yuragi recording"};

  const auto version = database_.integer("PRAGMA user_version");
  if (!version) return version.error();
  if (*version > kFormatVersion || *version < 1) {
    return Failure{name + ": is a recording of format " + std::to_string(*version) + "; this Yuragi reads format " +
                   std::to_string(kFormatVersion) + "; update Yuragi"};
  }
  return {};
}

Result<void, Failure> WindlogReader::load_sessions() {
  auto rows = database_.prepare("SELECT id, substr(software, 1, 256) FROM session ORDER BY id");
  if (!rows) return rows.error();
  Statement::Step step = rows->step();
  for (; step == Statement::Step::kRow && sessions_.size() < kMaxSessions; step = rows->step()) {
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
    if (!sessions_.empty()) {
      const Nanoseconds gap = session.first.utc - sessions_.back().last.utc;
      session.log_begin = sessions_.back().log_end() + std::max(gap, Nanoseconds{0});
    }
    const std::int64_t span_ns = (session.last.mono - session.first.mono).count();
    if (span_ns < 0 || session.log_begin.count() > kMaxTime_ns - span_ns) {
      return Failure{database_.file().string() + ": session " + std::to_string(session.id) +
                     " has impossible times; the file is damaged"};
    }
    sessions_.push_back(std::move(session));
  }
  if (step == Statement::Step::kFailed) return database_.failure();
  if (step == Statement::Step::kRow)
    return Failure{database_.file().string() + ": has an impossible number of sessions; the file is damaged"};
  return {};
}

Result<void, Failure> WindlogReader::load_sensors() {
  auto rows = database_.prepare(
      "SELECT id, session, substr(name, 1, 256), substr(driver, 1, 256), substr(options, 1, 4096) FROM sensor "
      "ORDER BY id");
  if (!rows) return rows.error();
  Statement::Step step = rows->step();
  for (; step == Statement::Step::kRow && sensors_.size() < kMaxSensors; step = rows->step()) {
    sensors_.push_back({rows->integer(0), rows->integer(1), rows->text(2), rows->text(3), rows->text(4)});
  }
  if (step == Statement::Step::kFailed) return database_.failure();
  if (step == Statement::Step::kRow)
    return Failure{database_.file().string() + ": has an impossible number of sensors; the file is damaged"};

  // reading_of_row() looks them up by id, whatever order a damaged file gave them in.
  std::stable_sort(sensors_.begin(), sensors_.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  return {};
}

Result<std::string, Failure> WindlogReader::configuration(std::int64_t session) {
  auto row = database_.prepare("SELECT configuration FROM session WHERE id = ?1");
  if (!row) return row.error();
  row->bind(1, session);
  switch (row->step()) {
    case Statement::Step::kRow:
      return {boost::system::in_place_value, row->text(0)};
    case Statement::Step::kDone:
      return Failure{database_.file().string() + ": has no session " + std::to_string(session)};
    case Statement::Step::kFailed:
      break;
  }
  return database_.failure();
}

Result<std::optional<LoggedReading>, Failure> WindlogReader::next() {
  while (next_in_block_ == block_.size()) {
    if (sessions_.empty()) return std::optional<LoggedReading>{};
    const auto rows = read_block();
    if (!rows) return rows.error();
    if (*rows > 0) continue;

    // The session is read. The last one may still grow.
    if (session_index_ + 1 == sessions_.size()) return std::optional<LoggedReading>{};
    begin_session(session_index_ + 1, Nanoseconds{0});
  }
  return std::optional<LoggedReading>(block_[next_in_block_++]);
}

/// Reads the next rows of the present session; returns their number.
Result<std::int64_t, Failure> WindlogReader::read_block() {
  const LoggedSession& session = sessions_[session_index_];
  block_.clear();
  next_in_block_ = 0;
  select_block_.bind(1, session.id);
  select_block_.bind(2, after_mono_ns_);
  select_block_.bind(3, after_row_);
  select_block_.bind(4, kMaxTime_ns);
  select_block_.bind(5, kBlockRows);

  std::int64_t mono_ns = after_mono_ns_;
  std::int64_t row = after_row_;
  std::int64_t rows = 0;
  std::size_t skipped = 0;
  std::optional<Failure> failure;
  Statement::Step step = select_block_.step();
  for (; step == Statement::Step::kRow; step = select_block_.step(), ++rows) {
    // An order that is not one means a damaged index, which could lead in circles.
    const std::pair key(select_block_.integer(3), select_block_.integer(0));
    if (key <= std::pair(mono_ns, row)) {
      failure = Failure{database_.file().string() + ": its index is damaged; `sqlite3 FILE REINDEX` may repair it"};
      break;
    }
    std::tie(mono_ns, row) = key;
    if (const auto logged = reading_of_row(session)) {
      block_.push_back(*logged);
    } else {
      ++skipped;
    }
  }
  if (step == Statement::Step::kFailed) failure = database_.failure();
  select_block_.reset();
  if (failure) {
    block_.clear();
    return *failure;
  }

  // Only now is the block taken, so that a failure leaves the place where it was.
  skipped_ += skipped;
  after_mono_ns_ = mono_ns;
  after_row_ = row;
  return rows;
}

/// The row that the block's statement stands at, if it can be a reading.
std::optional<LoggedReading> WindlogReader::reading_of_row(const LoggedSession& session) const {
  const auto is_number = [this](int column) {
    return select_block_.type(column) == SQLITE_FLOAT || select_block_.type(column) == SQLITE_INTEGER;
  };
  for (const int column : {1, 2, 3, 7}) {
    if (select_block_.type(column) != SQLITE_INTEGER) return std::nullopt;
  }
  if (!is_number(4)) return std::nullopt;
  for (const int column : {5, 6}) {
    if (!is_number(column) && select_block_.type(column) != SQLITE_NULL) return std::nullopt;
  }

  // The sensor must be one of this session.
  const std::int64_t id = select_block_.integer(1);
  const auto sensor =
      std::lower_bound(sensors_.begin(), sensors_.end(), id,
                       [](const LoggedSensor& candidate, std::int64_t wanted) { return candidate.id < wanted; });
  if (sensor == sensors_.end() || sensor->id != id || sensor->session != session.id) return std::nullopt;

  const std::int64_t utc_ns = select_block_.integer(2);
  const std::int64_t mono_ns = select_block_.integer(3);
  const std::int64_t quality = select_block_.integer(7);
  if (utc_ns < -kMaxTime_ns || utc_ns > kMaxTime_ns) return std::nullopt;
  if (mono_ns < session.first.mono.time_since_epoch().count()) return std::nullopt;
  if (quality < 0 || quality > static_cast<std::int64_t>(wind::ReadingQuality::kSimulated)) return std::nullopt;

  LoggedReading logged;
  logged.sensor = static_cast<std::size_t>(sensor - sensors_.begin());
  logged.log_time = session.log_begin + (mono_time(mono_ns) - session.first.mono);
  logged.reading.time = {mono_time(mono_ns), utc_time(utc_ns)};
  logged.reading.speed_m_s = select_block_.number(4);
  if (is_number(5)) logged.reading.direction_deg = select_block_.number(5);
  if (is_number(6)) logged.reading.gust_m_s = select_block_.number(6);
  logged.reading.quality = static_cast<wind::ReadingQuality>(quality);
  if (!wind::is_plausible(logged.reading)) return std::nullopt;
  return logged;
}

void WindlogReader::seek(Nanoseconds log_time) {
  skipped_ = 0;
  if (sessions_.empty()) return;
  std::size_t index = 0;
  while (index + 1 < sessions_.size() && sessions_[index].log_end() < log_time) ++index;
  begin_session(index, log_time - sessions_[index].log_begin);
}

void WindlogReader::begin_session(std::size_t index, Nanoseconds into_session) {
  block_.clear();
  next_in_block_ = 0;
  session_index_ = index;
  const Nanoseconds offset = std::clamp(into_session, Nanoseconds{0}, Nanoseconds{kMaxTime_ns});
  after_mono_ns_ = (sessions_[index].first.mono + offset).time_since_epoch().count();
  after_row_ = std::numeric_limits<std::int64_t>::min();
}

Result<std::optional<Nanoseconds>, Failure> WindlogReader::log_time_of(UtcTime moment) {
  auto first_after = database_.prepare(
      "SELECT mono_ns FROM reading WHERE session = ?1 AND mono_ns BETWEEN ?2 AND ?3 AND utc_ns BETWEEN ?4 AND ?3 "
      "ORDER BY mono_ns LIMIT 1");
  if (!first_after) return first_after.error();
  for (const LoggedSession& session : sessions_) {
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

Result<std::optional<Nanoseconds>, Failure> WindlogReader::last_log_time(const std::vector<bool>& of_sensors) {
  auto backward = database_.prepare(
      "SELECT mono_ns FROM reading WHERE session = ?1 AND sensor = ?2 AND mono_ns BETWEEN ?3 AND ?4 "
      "ORDER BY mono_ns DESC LIMIT 1");
  if (!backward) return backward.error();
  for (std::size_t back = 0; back < sessions_.size(); ++back) {
    const LoggedSession& session = sessions_[sessions_.size() - 1 - back];
    std::optional<Nanoseconds> last;
    for (std::size_t index = 0; index < sensors_.size(); ++index) {
      if (!of_sensors[index] || sensors_[index].session != session.id) continue;
      backward->bind(1, session.id);
      backward->bind(2, sensors_[index].id);
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

Result<void, Failure> WindlogReader::copy_to(const std::filesystem::path& copy) {
  auto vacuum = database_.prepare("VACUUM INTO ?1");
  if (!vacuum) return vacuum.error();
  const std::string name = std::filesystem::absolute(copy).string();
  vacuum->bind(1, std::string_view(name));
  if (vacuum->step() != Statement::Step::kDone) return database_.failure();
  return {};
}

}  // namespace yuragi::drivers::windlog
