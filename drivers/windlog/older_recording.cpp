#include "drivers/windlog/older_recording.hpp"

#include <string>
#include <system_error>

#include "drivers/windlog/file_format.hpp"
#include "drivers/windlog/recording_files.hpp"
#include "drivers/windlog/sqlite.hpp"

namespace yuragi::drivers::windlog {
namespace {

/// Returns the version of an older recording's format; nullopt for any other file.
std::optional<std::int64_t> older_format(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return std::nullopt;
  auto database = sqlite::Database::open(file, sqlite::Access::kReadOnly);
  if (!database) return std::nullopt;
  database->set_busy_timeout(sqlite::kBusyTimeout_ms);
  const auto format = format_of(*database);
  if (!format || !format->is_recording()) return std::nullopt;
  if (format->version < 1 || format->version >= kFormatVersion) return std::nullopt;
  return format->version;
}

}  // namespace

Result<std::optional<std::filesystem::path>, Failure> set_older_recording_aside(const std::filesystem::path& file) {
  const auto version = older_format(file);
  if (!version) return std::optional<std::filesystem::path>{};
  constexpr int kMaxNames = 1000;
  for (int number = 1; number <= kMaxNames; ++number) {
    std::filesystem::path aside = file.parent_path() / file.stem();
    aside += "-format" + std::to_string(*version) + (number == 1 ? "" : "-" + std::to_string(number));
    aside += file.extension();
    if (!is_free_name(aside)) continue;

    const std::error_code error = rename_recording(file, aside);
    if (!error) return std::optional(aside);
    return Failure{file.string() + ": cannot be renamed to " + aside.string() + ": " + error.message()};
  }
  return Failure{file.string() +
                 ": cannot be renamed, because all names for older recordings are taken; choose another file"};
}

}  // namespace yuragi::drivers::windlog
