#include "daemon/tools/support/recording_head.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <system_error>

#include <date/date.h>
#include <fmt/format.h>

#include "daemon/tools/csv/csv_export.hpp"
#include "drivers/windlog/recording_parts.hpp"
#include "drivers/windlog/windlog_reader.hpp"
#include "engine/base/count_text.hpp"

namespace yuragi::daemon::tools::support {
namespace {

constexpr std::size_t kReadingsBetweenLooks = 10'000;

std::string text_of(UtcTime moment) {
  return date::format("%FT%TZ", std::chrono::floor<std::chrono::seconds>(moment));
}

std::string files_text(const std::filesystem::path& recording) {
  std::vector<std::filesystem::path> files;
  for (const drivers::windlog::RecordingPart& part : drivers::windlog::completed_parts(recording))
    files.push_back(part.file);
  files.push_back(recording);
  std::string text;
  for (const std::filesystem::path& file : files) {
    std::error_code error;
    const std::uintmax_t bytes = std::filesystem::file_size(file, error);
    text += error ? fmt::format("{}: {}\n", file.string(), error.message())
                  : fmt::format("{}: {} bytes\n", file.string(), bytes);
  }
  return text;
}

/// "roof (modbus): 1000 readings", for each sensor by its name.
std::string counts_text(drivers::windlog::Reader& reader, Nanoseconds patience) {
  std::map<std::string, std::size_t> counts;
  for (const drivers::windlog::LoggedSensor& sensor : reader.sensors())
    counts.emplace(fmt::format("{} ({})", sensor.name, sensor.driver), 0);
  const auto deadline = std::chrono::steady_clock::now() + patience;
  bool is_complete = false;
  std::string failure;
  for (std::size_t count = 0;; ++count) {
    if (count % kReadingsBetweenLooks == 0 && std::chrono::steady_clock::now() > deadline) break;
    const auto reading = reader.next();
    if (!reading) failure = reading.error().message;
    is_complete = reading && !*reading;
    if (!reading || !*reading) break;
    const drivers::windlog::LoggedSensor& sensor = reader.sensors()[(*reading)->sensor];
    ++counts[fmt::format("{} ({})", sensor.name, sensor.driver)];
  }
  std::string text;
  for (const auto& [sensor, count] : counts)
    text += fmt::format("sensor {}: {}{}\n", sensor, is_complete ? "" : "at least ", count_text(count, "reading"));
  if (reader.skipped() > 0) text += fmt::format("{} rows cannot be readings\n", reader.skipped());
  if (!failure.empty()) text += "reading stopped: " + failure + "\n";
  return text;
}

}  // namespace

std::string recording_head(const std::filesystem::path& recording, Nanoseconds patience) {
  std::string text = files_text(recording);
  auto reader = drivers::windlog::Reader::open(recording);
  if (!reader) return text + reader.error().message + "\n";
  for (const drivers::windlog::LoggedSession& session : reader->sessions()) {
    text += fmt::format("session {}: {} to {}, {}\n", session.id, text_of(session.first.utc), text_of(session.last.utc),
                        session.software);
  }
  return text + counts_text(*reader, patience);
}

std::string last_hour(const std::filesystem::path& recording) {
  auto reader = drivers::windlog::Reader::open(recording);
  if (!reader) return reader.error().message + "\n";
  char* bytes = nullptr;
  std::size_t size = 0;
  std::FILE* const file = open_memstream(&bytes, &size);
  if (file == nullptr) return "no memory for it\n";
  const Nanoseconds from = std::max(Nanoseconds{0}, reader->duration() - std::chrono::hours(1));
  const auto report = csv::export_csv(*reader, {.from = from}, file);
  std::fclose(file);  // sets bytes and size for good
  std::string text(bytes, size);
  std::free(bytes);  // NOLINT(cppcoreguidelines-no-malloc): it is open_memstream's
  return report ? text : text + report.error().message + "\n";
}

}  // namespace yuragi::daemon::tools::support
