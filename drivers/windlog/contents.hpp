#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "drivers/windlog/sqlite.hpp"

namespace yuragi::drivers::windlog {

inline constexpr std::int64_t kBlockRows = 512;
// More than a recorder makes in years; a file with more is no recording.
inline constexpr std::size_t kMaxSessions = 1'000'000;
inline constexpr std::size_t kMaxSensorsOfRecording = 1'000'000;

inline Failure impossible_times(const sqlite::Database& database, std::int64_t session) {
  return {
      database.file().string() + ": session " + std::to_string(session) + " has impossible times; the file is damaged",
      FailureKind::kBadData};
}

/// The end of a list that was read row by row up to its limit: its last step must have found no row.
inline Result<void, Failure> end_of_list(const sqlite::Database& database, sqlite::Statement::Step last,
                                         std::string_view what) {
  switch (last) {
    case sqlite::Statement::Step::kDone:
      return {};
    case sqlite::Statement::Step::kRow:
      return Failure{
          database.file().string() + ": has an impossible number of " + std::string(what) + "; the file is damaged",
          FailureKind::kBadData};
    case sqlite::Statement::Step::kFailed:
      break;
  }
  return database.failure();
}

/// The configuration text of a session, of either version.
inline Result<std::string, Failure> configuration_of(sqlite::Database& database, std::int64_t session) {
  auto row = database.prepare("SELECT configuration FROM session WHERE id = ?1");
  if (!row) return row.error();
  row->bind(1, session);
  switch (row->step()) {
    case sqlite::Statement::Step::kRow:
      return {boost::system::in_place_value, row->text(0)};
    case sqlite::Statement::Step::kDone:
      return Failure{database.file().string() + ": has no session " + std::to_string(session)};
    case sqlite::Statement::Step::kFailed:
      break;
  }
  return database.failure();
}

}  // namespace yuragi::drivers::windlog
