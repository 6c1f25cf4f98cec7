#include "drivers/windlog/verify_recording.hpp"

#include <algorithm>
#include <map>
#include <system_error>
#include <utility>

#include "drivers/windlog/file_identity.hpp"
#include "drivers/windlog/format.hpp"
#include "drivers/windlog/recording_parts.hpp"
#include "drivers/windlog/session_count.hpp"
#include "drivers/windlog/sqlite.hpp"
#include "drivers/windlog/stored_file.hpp"
#include "engine/base/count_text.hpp"

namespace yuragi::drivers::windlog {
namespace {

using sqlite::Statement;

/// By session and the sensor's name.
using Counts = std::map<std::pair<std::int64_t, std::string>, SessionCount>;

/// Finds the gaps of each sensor through all files.
class GapFinder {
 public:
  explicit GapFinder(Nanoseconds max_gap) : max_gap_(max_gap) {}

  /// `session`: different for each session of each file; the monotonic clock is comparable inside one only.
  void look(const std::string& sensor, std::pair<std::size_t, std::int64_t> session, const Instant& time) {
    const auto [last, is_first] = last_.try_emplace(sensor, Last{session, time});
    if (is_first) return;
    const bool is_same_session = last->second.session == session;
    const Instant before = std::exchange(last->second, {session, time}).time;
    const Nanoseconds length = is_same_session ? time.mono - before.mono : time.utc - before.utc;
    if (length > max_gap_) gaps.push_back({sensor, before.utc, time.utc, length});
  }

  std::vector<RecordingGap> gaps;

 private:
  struct Last {
    std::pair<std::size_t, std::int64_t> session;
    Instant time;
  };
  Nanoseconds max_gap_;
  std::map<std::string, Last> last_;
};

/// Checks one file that is open, as it is at one moment.
class FileCheck {
 public:
  FileCheck(StoredFile& file, VerifiedFile& result)
      : database_(*file.database), stored_(*file.readings), result_(result) {}

  /// `index`: of the file in the series.
  void run(std::size_t index, GapFinder& gaps) {
    note(check_pages());
    note(check_references());
    const auto read = read_all(index, gaps);
    if (!note(read)) return;
    note(check_rows());
    note(check_counts());
  }

  /// The file before it in the series, by the moment in its name; nullopt if it names none.
  std::optional<UtcTime> previous_part() {
    const auto begin_ns = database_.integer("SELECT begin_utc_ns FROM " + std::string(kPreviousPartTable));
    if (!begin_ns || *begin_ns < -kMaxTime_ns || *begin_ns > kMaxTime_ns) return std::nullopt;
    return UtcTime(Nanoseconds(*begin_ns));
  }

 private:
  bool note(const Result<void, Failure>& done) {
    if (!done) result_.damage.push_back(done.error().message);
    return !done.has_error();
  }

  Result<void, Failure> check_pages() {
    auto rows = database_.prepare("PRAGMA integrity_check(10)");
    if (!rows) return rows.error();
    Statement::Step step = rows->step();
    for (; step == Statement::Step::kRow; step = rows->step()) {
      if (const std::string finding = rows->text(0); finding != "ok") result_.damage.push_back(finding);
    }
    if (step == Statement::Step::kFailed) return database_.failure();
    return {};
  }

  Result<void, Failure> check_references() {
    auto rows = database_.prepare("SELECT count(*) FROM pragma_foreign_key_check");
    if (!rows) return rows.error();
    if (rows->step() != Statement::Step::kRow) return database_.failure();
    if (const auto count = static_cast<std::uint64_t>(rows->integer(0)); count > 0) {
      result_.damage.push_back(count_text(count, "row") + " of sensors without their session or series");
    }
    return {};
  }

  /// Fails if the times are not in order, too.
  Result<void, Failure> read_all(std::size_t index, GapFinder& gaps) {
    auto streams = stored_.blocks(std::vector<bool>(stored_.sensors.size(), true));
    if (!streams) return streams.error();
    std::vector<LoggedReading> block;
    for (const auto& stream : *streams) {
      while (true) {
        if (auto read = stream->read(block, skipped_); !read) return read;
        if (block.empty()) break;
        for (const LoggedReading& logged : block) {
          const LoggedSensor& sensor = stored_.sensors[logged.sensor];
          const wind::Reading& reading = logged.reading;
          found_[{sensor.session, sensor.name}].add(reading);
          gaps.look(sensor.name, {index, sensor.session}, reading.time);
          result_.first = std::min(result_.first.value_or(reading.time.utc), reading.time.utc);
          result_.last = std::max(result_.last.value_or(reading.time.utc), reading.time.utc);
        }
        result_.readings += block.size();
      }
    }
    result_.sessions = stored_.sessions.size();
    return {};
  }

  /// All rows of all tables of readings must have been read, and be readings.
  Result<void, Failure> check_rows() {
    auto tables = database_.prepare(
        "SELECT name FROM sqlite_schema WHERE type = 'table' AND "
        "(name = 'reading' OR name GLOB 'reading_[1-9]*') AND name NOT GLOB 'reading_*[^0-9]*'");
    if (!tables) return tables.error();
    std::uint64_t rows = 0;
    Statement::Step step = tables->step();
    for (; step == Statement::Step::kRow; step = tables->step()) {
      const auto count = database_.integer("SELECT count(*) FROM " + tables->text(0));
      if (!count) return count.error();
      rows += static_cast<std::uint64_t>(*count);
    }
    if (step == Statement::Step::kFailed) return database_.failure();
    if (skipped_ > 0) result_.damage.push_back(count_text(skipped_, "row") + " that cannot be readings");
    if (const std::uint64_t read = result_.readings + skipped_; rows > read) {
      result_.damage.push_back(count_text(rows - read, "reading") + " without a session or sensor");
    }
    return {};
  }

  /// Compares what was found with what sessions counted when they were closed.
  Result<void, Failure> check_counts() {
    const auto tables = database_.integer("SELECT count(*) FROM sqlite_schema WHERE type = 'table' AND name = '" +
                                          std::string(kSessionCountTable) + "'");
    if (!tables) return tables.error();
    Counts counted;
    if (*tables > 0) {
      auto rows = database_.prepare("SELECT session, substr(name, 1, 256), readings, checksum FROM " +
                                    std::string(kSessionCountTable) + " LEFT JOIN series ON series.id = series");
      if (!rows) return rows.error();
      Statement::Step step = rows->step();
      for (; step == Statement::Step::kRow; step = rows->step()) {
        SessionCount& count = counted[{rows->integer(0), rows->text(1)}];
        count.readings += static_cast<std::uint64_t>(rows->integer(2));
        count.checksum += static_cast<std::uint64_t>(rows->integer(3));
      }
      if (step == Statement::Step::kFailed) return database_.failure();
    }
    compare(counted);
    return {};
  }

  void compare(const Counts& counted) {
    for (const auto& [key, count] : counted) {
      const auto& [session, sensor] = key;
      const auto at = found_.find(key);
      const SessionCount found = at == found_.end() ? SessionCount{} : at->second;
      if (found == count) continue;
      const std::string where = "session " + std::to_string(session) + ", sensor " + sensor + ": ";
      result_.damage.push_back(where + (found.readings == count.readings
                                            ? "readings were changed"
                                            : count_text(found.readings, "reading") + " of the " +
                                                  std::to_string(count.readings) + " that were written"));
    }
    result_.sessions_without_count =
        static_cast<std::size_t>(std::ranges::count_if(stored_.sessions, [&counted](const LoggedSession& session) {
          const auto at = counted.lower_bound({session.id, ""});
          return at == counted.end() || at->first.first != session.id;
        }));
  }

  sqlite::Database& database_;
  StoredReadings& stored_;
  VerifiedFile& result_;
  Counts found_;
  std::size_t skipped_ = 0;
};

/// Its content is in `verification`.
struct Seen {
  std::vector<FileIdentity> files;
  std::vector<UtcTime> previous;  ///< parts that files name as the ones before them
};

/// False if it was verified before.
bool verify_file(const std::filesystem::path& file, Verification& verification, Seen& seen, GapFinder& gaps) {
  const auto identity = identity_of(file);
  if (!identity || std::ranges::find(seen.files, *identity) != seen.files.end()) return false;
  seen.files.push_back(*identity);
  VerifiedFile& result = verification.files.emplace_back();
  result.file = file;
  auto opened = open_stored_file(file, {}, true);
  if (!opened) {
    if (!is_blank_file(file)) result.damage.push_back(opened.error().message);
    return true;
  }
  FileCheck check(*opened, result);
  check.run(verification.files.size(), gaps);
  if (const auto previous = check.previous_part()) seen.previous.push_back(*previous);
  return true;
}

}  // namespace

bool Verification::is_sound() const {
  return missing.empty() && std::ranges::all_of(files, [](const VerifiedFile& file) { return file.damage.empty(); });
}

Result<Verification, Failure> verify_recording(const std::filesystem::path& recording, Nanoseconds max_gap) {
  if (!recording_exists(recording)) {
    return Failure{recording.string() + ": the recording does not exist", FailureKind::kNoInput};
  }
  Verification verification;
  Seen seen;
  GapFinder gaps(max_gap);
  // Its writer may complete a file meanwhile, which then has another name, and begin the next.
  for (bool is_new = true; is_new;) {
    is_new = false;
    for (const auto& file : recording_files(recording)) is_new |= verify_file(file, verification, seen, gaps);
  }
  verification.gaps = std::move(gaps.gaps);
  std::ranges::stable_sort(verification.gaps, {}, &RecordingGap::from);

  // The oldest files may have been deleted by the rules.
  const auto parts = completed_parts(recording);
  std::ranges::sort(seen.previous);
  seen.previous.erase(std::unique(seen.previous.begin(), seen.previous.end()), seen.previous.end());
  for (const UtcTime begin : seen.previous) {
    if (!parts.empty() && parts.front().begin < begin &&
        std::ranges::find(parts, begin, &RecordingPart::begin) == parts.end()) {
      verification.missing.push_back(part_name(recording, begin));
    }
  }
  return verification;
}

}  // namespace yuragi::drivers::windlog
