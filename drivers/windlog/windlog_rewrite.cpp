#include "drivers/windlog/windlog_rewrite.hpp"

#include <cstdint>
#include <limits>
#include <system_error>

#include "drivers/windlog/file_format.hpp"
#include "drivers/windlog/series_lock.hpp"
#include "drivers/windlog/sqlite.hpp"
#include "drivers/windlog/stored_file.hpp"

namespace yuragi::drivers::windlog {
namespace {

using sqlite::Statement;

Failure rewrite_failure(const sqlite::Database& database) {
  return {database.failure().message, FailureKind::kCannotCreate};
}

/// Returns true if it is a recording of a format that this program knows.
Result<void, Failure> check_is_recording(sqlite::Database& database) {
  const std::string name = database.file().string();
  const auto format = format_of(database);
  if (!format) return Failure{format.error().message, FailureKind::kBadData};
  if (!format->is_recording()) return Failure{name + ": is not a Yuragi recording", FailureKind::kBadData};
  if (format->version > kFormatVersion) {
    return Failure{name + ": was written by a newer Yuragi; update this one", FailureKind::kBadData};
  }
  return {};
}

/// Takes the file for this connection alone, as one file without a write-ahead log.
Result<void, Failure> take(sqlite::Database& database) {
  // Every other connection to a file with such a log prevents the change of the mode; a reader of one without it has a
  // lock while it reads.
  const auto taken = database.run("PRAGMA journal_mode = DELETE; PRAGMA locking_mode = EXCLUSIVE; BEGIN EXCLUSIVE");
  if (taken) return {};
  if (const int code = database.error_code(); code == SQLITE_BUSY || code == SQLITE_LOCKED) {
    return Failure{
        database.file().string() + ": is being recorded, or read by another program; stop that program first",
        FailureKind::kUnavailable};
  }
  return rewrite_failure(database);
}

/// Rewrites each row of a table: `select` gives id, driver and text of the row after an id, `update` takes id and text.
template <class Rewrite>
Result<std::size_t, Failure> rewrite_rows(sqlite::Database& database, const char* select, const char* update,
                                          const Rewrite& rewrite) {
  auto next_row = database.prepare(select);
  if (!next_row) return Failure{next_row.error().message, FailureKind::kBadData};
  auto change_row = database.prepare(update);
  if (!change_row) return Failure{change_row.error().message, FailureKind::kBadData};

  std::size_t changed = 0;
  std::int64_t after = std::numeric_limits<std::int64_t>::min();
  while (true) {
    next_row->bind(1, after);
    const Statement::Step step = next_row->step();
    if (step == Statement::Step::kDone) return changed;
    if (step == Statement::Step::kFailed) return rewrite_failure(database);
    after = next_row->integer(0);
    const std::string driver = next_row->text(1);
    const std::string text = next_row->text(2);
    next_row->reset();

    const std::optional<std::string> rewritten = rewrite(driver, text);
    if (!rewritten || *rewritten == text) continue;
    change_row->bind(1, after);
    change_row->bind(2, std::string_view(*rewritten));
    if (change_row->step() != Statement::Step::kDone) return rewrite_failure(database);
    change_row->reset();
    ++changed;
  }
}

Result<std::size_t, Failure> rewrite_all(sqlite::Database& database, const TextRewrite& rewrite) {
  const auto configurations =
      rewrite_rows(database, "SELECT id, '', configuration FROM session WHERE id > ?1 ORDER BY id LIMIT 1",
                   "UPDATE session SET configuration = ?2 WHERE id = ?1",
                   [&](const std::string&, const std::string& text) { return rewrite.configuration(text); });
  if (!configurations) return configurations.error();
  const auto options =
      rewrite_rows(database, "SELECT id, driver, options FROM sensor WHERE id > ?1 ORDER BY id LIMIT 1",
                   "UPDATE sensor SET options = ?2 WHERE id = ?1", rewrite.options);
  if (!options) return options.error();
  return *configurations + *options;
}

}  // namespace

Result<std::size_t, Failure> rewrite_texts(const std::filesystem::path& file, const TextRewrite& rewrite) {
  if (const auto checked = check_is_file(file); !checked) return checked.error();

  const auto lock = SeriesLock::take(file);
  if (!lock) return lock.error();
  auto database = sqlite::Database::open(file, sqlite::Access::kReadWrite);
  if (!database) return database.error();
  database->set_busy_timeout(sqlite::kBusyTimeout_ms);
  if (const auto done = check_is_recording(*database); !done) return done.error();
  // What is overwritten or deleted is filled with zeros.
  if (!database->run("PRAGMA secure_delete = ON")) return rewrite_failure(*database);
  if (const auto done = take(*database); !done) return done.error();

  auto changed = rewrite_all(*database, rewrite);
  if (!changed) return changed;  // closing takes it all back
  if (!database->run("COMMIT")) return rewrite_failure(*database);
  // The zeros are this connection's doing: what earlier ones left in parts of the file that are no longer used goes
  // when all pages are written anew.
  if (*changed > 0 && !database->run("VACUUM")) {
    return Failure{"the texts were changed, but traces of the old ones may be left in unused parts of the file: " +
                       database->failure().message + "; `yuragi export` makes a copy without them",
                   FailureKind::kCannotCreate};
  }
  return changed;
}

}  // namespace yuragi::drivers::windlog
