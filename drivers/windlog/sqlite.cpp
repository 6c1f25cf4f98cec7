#include "drivers/windlog/sqlite.hpp"

#include <array>
#include <system_error>

namespace yuragi::drivers::windlog::sqlite {
namespace {

/// A file name as SQLite takes it in a URI.
std::string uri_of(const std::filesystem::path& file) {
  std::string uri = "file:";
  for (const char c : file.string()) {
    switch (c) {
      case '%':
        uri += "%25";
        break;
      case '?':
        uri += "%3f";
        break;
      case '#':
        uri += "%23";
        break;
      default:
        uri += c;
    }
  }
  return uri + "?immutable=1";
}

/// What a person can do about an error.
std::string_view advice_for(int code) {
  switch (code) {
    case SQLITE_FULL:
      return "free some space on it";
    case SQLITE_IOERR:
      return "check the disk";
    case SQLITE_PERM:
    case SQLITE_AUTH:
    case SQLITE_READONLY:
    case SQLITE_CANTOPEN:
      return "check that the file and its folder exist and that this user may open them";
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return "another program uses it; stop that one, or wait for it";
    case SQLITE_NOTADB:
      return "this is not a Yuragi recording";
    case SQLITE_INTERRUPT:
      return "it was interrupted";
    case SQLITE_CORRUPT:
      return "the file is damaged; `sqlite3 FILE .recover` may save what is left";
    default:
      return "its readings cannot be trusted";
  }
}

}  // namespace

void Statement::bind(int position, std::string_view text) {
  sqlite3_bind_text64(statement_.get(), position, text.data(), text.size(), SQLITE_STATIC, SQLITE_UTF8);
}

void Statement::bind(int position, const std::optional<double>& value) {
  if (value) {
    bind(position, *value);
  } else {
    sqlite3_bind_null(statement_.get(), position);
  }
}

Statement::Step Statement::step() {
  switch (sqlite3_step(statement_.get())) {
    case SQLITE_ROW:
      return Step::kRow;
    case SQLITE_DONE:
      return Step::kDone;
    default:
      return Step::kFailed;
  }
}

std::string Statement::text(int column) const {
  const unsigned char* bytes = sqlite3_column_text(statement_.get(), column);
  if (bytes == nullptr) return {};
  const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column));
  return {bytes, bytes + size};
}

Result<Database, Failure> Database::open(const std::filesystem::path& file, Access access) {
  int flags = SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE;
  switch (access) {
    case Access::kReadOnly:
      flags |= SQLITE_OPEN_READONLY;
      break;
    case Access::kReadFrozen:
      flags |= SQLITE_OPEN_READONLY | SQLITE_OPEN_URI;
      break;
    case Access::kReadWrite:
      flags |= SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
      break;
  }

  // Absolute, so that no name is taken for a URI or for SQLite's ":memory:".
  std::error_code error;
  const std::filesystem::path absolute = std::filesystem::absolute(file, error);
  if (error) return Failure{file.string() + ": " + error.message()};
  const std::string name = access == Access::kReadFrozen ? uri_of(absolute) : absolute.string();

  sqlite3* connection = nullptr;
  const int code = sqlite3_open_v2(name.c_str(), &connection, flags, nullptr);
  Database database(connection, file);
  if (connection == nullptr) return Failure{file.string() + ": out of memory"};
  if (code != SQLITE_OK) return database.failure();

  // What sqlite.org/security.html advises for files from strangers.
  static constexpr std::array<std::array<int, 2>, 4> kSettings = {{{SQLITE_DBCONFIG_DEFENSIVE, 1},
                                                                   {SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0},
                                                                   {SQLITE_DBCONFIG_ENABLE_TRIGGER, 0},
                                                                   {SQLITE_DBCONFIG_ENABLE_VIEW, 0}}};
  for (const auto& [setting, value] : kSettings) sqlite3_db_config(connection, setting, value, nullptr);
  static constexpr int kMaxTextBytes = 16 << 20;
  sqlite3_limit(connection, SQLITE_LIMIT_LENGTH, kMaxTextBytes);
  if (const auto done = database.run("PRAGMA cell_size_check = ON; PRAGMA mmap_size = 0"); !done) return done.error();
  return database;
}

void Database::end_on(const std::stop_token& stop) {
  if (!stop.stop_possible()) return;
  constexpr int kInstructionsBetweenLooks = 10'000;  // of SQLite's machine: well under a millisecond
  stop_ = std::make_unique<std::stop_token>(stop);
  sqlite3_progress_handler(
      connection_.get(), kInstructionsBetweenLooks,
      [](void* token) { return static_cast<std::stop_token*>(token)->stop_requested() ? 1 : 0; }, stop_.get());
}

Result<void, Failure> Database::run(const char* sql) {
  if (sqlite3_exec(connection_.get(), sql, nullptr, nullptr, nullptr) != SQLITE_OK) return failure();
  return {};
}

Result<Statement, Failure> Database::prepare(std::string_view sql) {
  sqlite3_stmt* statement = nullptr;
  const int code = sqlite3_prepare_v3(connection_.get(), sql.data(), static_cast<int>(sql.size()),
                                      SQLITE_PREPARE_PERSISTENT, &statement, nullptr);
  if (code != SQLITE_OK) return failure();
  return Statement(statement);
}

Result<std::int64_t, Failure> Database::integer(std::string_view sql) {
  auto statement = prepare(sql);
  if (!statement) return statement.error();
  switch (statement->step()) {
    case Statement::Step::kRow:
      return statement->integer(0);
    case Statement::Step::kDone:
      return Failure{file_.string() + ": the recording is incomplete"};
    case Statement::Step::kFailed:
      break;
  }
  return failure();
}

Failure Database::failure() const {
  std::string message = file_.string() + ": " + sqlite3_errmsg(connection_.get());
  if (const int error = sqlite3_system_errno(connection_.get()); error != 0) {
    message += " (" + std::system_category().message(error) + ")";
  }
  const bool is_damaged = error_code() == SQLITE_CORRUPT || error_code() == SQLITE_NOTADB;
  return {message.append("; ").append(advice_for(error_code())),
          is_damaged ? FailureKind::kBadData : FailureKind::kOther};
}

}  // namespace yuragi::drivers::windlog::sqlite
