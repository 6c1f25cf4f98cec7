#pragma once

#include <cstdint>

#include "drivers/windlog/format.hpp"
#include "drivers/windlog/sqlite.hpp"
#include "engine/base/result.hpp"

namespace yuragi::drivers::windlog {

/// The marks in a database that show its kind.
struct FileFormat {
  std::int64_t application = 0;
  std::int64_t version = 0;  ///< of a recording's format
  std::int64_t objects = 0;  ///< tables and the like

  bool is_recording() const { return application == kApplicationId; }
  /// Returns true if it was never written to: a new file, or one whose first write was never completed.
  bool is_blank() const { return application == 0 && objects == 0; }
};

/// Fails if the database cannot be read.
inline Result<FileFormat, Failure> format_of(sqlite::Database& database) {
  const auto application = database.integer("PRAGMA application_id");
  if (!application) return application.error();
  const auto version = database.integer("PRAGMA user_version");
  if (!version) return version.error();
  const auto objects = database.integer("SELECT count(*) FROM sqlite_schema");
  if (!objects) return objects.error();
  return FileFormat{.application = *application, .version = *version, .objects = *objects};
}

}  // namespace yuragi::drivers::windlog
