#include "drivers/windlog/stored_file.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <shared_mutex>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "drivers/windlog/file_format.hpp"
#include "drivers/windlog/recording_files.hpp"
#include "drivers/windlog/series_tables.hpp"
#include "drivers/windlog/shared_table.hpp"

namespace yuragi::drivers::windlog {
namespace {

std::filesystem::path wal_of(const std::filesystem::path& file) {
  return file.string() + std::string(kWalSuffix);
}

bool is_absent_or_empty(const std::filesystem::path& file) {
  std::error_code error;
  const auto size = std::filesystem::file_size(file, error);
  return error || size == 0;
}

/// What a file is that was given in place of a recording; empty if it begins like a database, or is empty.
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

/// Returns the version of the format.
Result<std::int64_t, Failure> version_of(sqlite::Database& database) {
  const std::string name = database.file().string();
  const auto format = format_of(database);
  if (!format) {
    if (database.error_code() == SQLITE_CANTOPEN && !is_absent_or_empty(wal_of(database.file()))) {
      return Failure{name + ": its newest readings are still in " + wal_of(database.file()).string() +
                     ", which needs a writable folder; copy both files to one"};
    }
    return format.error();
  }
  if (!format->is_recording()) return Failure{name + ": is not a Yuragi recording"};
  if (format->version > kFormatVersion || format->version < 1) {
    return Failure{name + ": is a recording of format " + std::to_string(format->version) +
                   "; this Yuragi reads formats 1 to " + std::to_string(kFormatVersion) + "; update Yuragi"};
  }
  return format->version;
}

Result<StoredFile, Failure> open_as(const std::filesystem::path& file, sqlite::Access access,
                                    const std::stop_token& stop, bool is_snapshot) {
  std::shared_lock names(recording_names());
  auto opened = sqlite::Database::open(file, access);
  if (!opened) return opened.error();
  auto database = std::make_unique<sqlite::Database>(std::move(*opened));
  database->set_busy_timeout(sqlite::kBusyTimeout_ms);
  database->end_on(stop);
  if (is_snapshot) {
    if (const auto begun = database->run("BEGIN"); !begun) return begun.error();
  }
  const auto version = version_of(*database);
  if (!version) return version.error();
  names.unlock();
  auto readings = *version == 1 ? open_shared_table(*database) : open_series_tables(*database);
  if (!readings) return readings.error();
  return StoredFile{.database = std::move(database), .readings = std::move(*readings)};
}

}  // namespace

Result<void, Failure> check_is_file(const std::filesystem::path& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status))
    return Failure{file.string() + ": the recording does not exist", FailureKind::kNoInput};
  if (!std::filesystem::is_regular_file(status))
    return Failure{file.string() + ": is not a file", FailureKind::kBadData};
  return {};
}

bool is_blank_file(const std::filesystem::path& file) {
  const std::shared_lock names(recording_names());
  auto opened = sqlite::Database::open(file, sqlite::Access::kReadOnly);
  if (!opened) return false;
  const auto format = format_of(*opened);
  return format && format->is_blank();
}

Result<StoredFile, Failure> open_stored_file(const std::filesystem::path& file, const std::stop_token& stop,
                                             bool is_snapshot) {
  if (const auto checked = check_is_file(file); !checked) return checked.error();

  auto opened = open_as(file, sqlite::Access::kReadOnly, stop, is_snapshot);
  if (opened) return opened;

  // In a folder where nothing can be created SQLite cannot share the file, but a file that was closed needs no sharing.
  if (is_absent_or_empty(wal_of(file))) {
    if (auto frozen = open_as(file, sqlite::Access::kReadFrozen, stop, is_snapshot)) return frozen;
  }
  // Not where it may be a recording that this process writes: closing any file releases the locks that SQLite has on
  // it.
  if (opened.error().kind == FailureKind::kBadData) {
    if (const std::string kind = foreign_kind(file); !kind.empty()) {
      return Failure{file.string() + ": " + kind, FailureKind::kBadData};
    }
  }
  return Failure{opened.error().message, FailureKind::kBadData};
}

}  // namespace yuragi::drivers::windlog
