#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>

#include <sqlite3.h>

#include "engine/base/result.hpp"

namespace yuragi::drivers::windlog::sqlite {

enum class Access : std::uint8_t {
  kReadOnly,
  kReadFrozen,  ///< reads a file without a writer, with no lock: for folders in which nothing can be created
  kReadWrite,   ///< creates the file if it is missing
};

/// How long a statement waits for another writer of the same file: a second recorder, or a checkpoint.
inline constexpr int kBusyTimeout_ms = 1000;

/// A prepared statement. Texts that are bound must live until the statement is reset. Thread-safe: no.
class Statement {
 public:
  enum class Step : std::uint8_t { kRow, kDone, kFailed };

  Statement() = default;
  explicit Statement(sqlite3_stmt* statement) : statement_(statement) {}

  void bind(int position, std::int64_t value) { sqlite3_bind_int64(statement_.get(), position, value); }
  void bind(int position, double value) { sqlite3_bind_double(statement_.get(), position, value); }
  void bind(int position, std::string_view text);
  void bind(int position, const std::optional<double>& value);

  Step step();
  void reset() { sqlite3_reset(statement_.get()); }

  int type(int column) const { return sqlite3_column_type(statement_.get(), column); }
  std::int64_t integer(int column) const { return sqlite3_column_int64(statement_.get(), column); }
  double number(int column) const { return sqlite3_column_double(statement_.get(), column); }
  std::string text(int column) const;

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
  };
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

/// A connection to one database file, set up against hostile content: the file's own triggers and views are never run.
/// Owns the connection. Thread-safe: no; one thread at a time.
class Database {
 public:
  /// SQLite itself looks at the file only with the first statement.
  static Result<Database, Failure> open(const std::filesystem::path& file, Access access);

  Result<void, Failure> run(const char* sql);
  Result<Statement, Failure> prepare(std::string_view sql);
  /// The first column of the first row; a failure if there is none.
  Result<std::int64_t, Failure> integer(std::string_view sql);

  /// Makes this connection's statements fail within milliseconds once `stop` is requested.
  void end_on(const std::stop_token& stop);

  /// How many rows the last INSERT, UPDATE or DELETE changed.
  std::int64_t changed_rows() const { return sqlite3_changes(connection_.get()); }
  std::int64_t last_id() const { return sqlite3_last_insert_rowid(connection_.get()); }
  bool in_transaction() const { return sqlite3_get_autocommit(connection_.get()) == 0; }
  void set_busy_timeout(int timeout_ms) { sqlite3_busy_timeout(connection_.get(), timeout_ms); }

  /// The last error's primary code (SQLITE_BUSY, ...), and its sentence for a person: the file, what is wrong, what to
  /// do.
  int error_code() const { return 0xff & sqlite3_errcode(connection_.get()); }
  Failure failure() const;

  const std::filesystem::path& file() const { return file_; }

  bool is_open() const { return connection_ != nullptr; }
  /// Rolls back what is not committed. Statements must be gone before.
  void close() { connection_.reset(); }

 private:
  Database(sqlite3* connection, std::filesystem::path file) : connection_(connection), file_(std::move(file)) {}

  struct Close {
    void operator()(sqlite3* connection) const { sqlite3_close_v2(connection); }
  };
  std::unique_ptr<std::stop_token> stop_;  // the connection refers to it
  std::unique_ptr<sqlite3, Close> connection_;
  std::filesystem::path file_;
};

}  // namespace yuragi::drivers::windlog::sqlite
