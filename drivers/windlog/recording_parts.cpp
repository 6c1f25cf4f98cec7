#include "drivers/windlog/recording_parts.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>
#include <string>
#include <system_error>

namespace yuragi::drivers::windlog {
namespace {

constexpr const char* kMoment = "%Y%m%dT%H%M%SZ";

}  // namespace

std::filesystem::path part_name(const std::filesystem::path& recording, UtcTime begin) {
  const std::time_t seconds = std::chrono::floor<std::chrono::seconds>(begin).time_since_epoch().count();
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  std::array<char, 32> moment{};
  std::strftime(moment.data(), moment.size(), kMoment, &utc);
  std::filesystem::path part = recording.parent_path() / recording.stem();
  part += std::string("-") + moment.data() + recording.extension().string();
  return part;
}

std::optional<UtcTime> begin_of_part(const std::filesystem::path& recording, const std::filesystem::path& file) {
  const std::string stem = recording.stem().string() + "-";
  const std::string name = file.stem().string();
  if (file.extension() != recording.extension() || !name.starts_with(stem)) return std::nullopt;
  std::tm utc{};
  const char* const end = strptime(name.c_str() + stem.size(), kMoment, &utc);
  if (end == nullptr || *end != '\0') return std::nullopt;
  const UtcTime begin{std::chrono::seconds(timegm(&utc))};
  // Only what part_name() makes: strptime() takes shorter numbers, too.
  if (part_name(recording, begin).filename() != file.filename()) return std::nullopt;
  return begin;
}

std::vector<RecordingPart> completed_parts(const std::filesystem::path& recording) {
  std::vector<RecordingPart> parts;
  std::error_code error;
  const std::filesystem::path folder = recording.has_parent_path() ? recording.parent_path() : ".";
  for (auto entry = std::filesystem::directory_iterator(folder, error);
       !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    const std::filesystem::path file = recording.parent_path() / entry->path().filename();
    std::error_code is_unknown;
    if (!entry->is_regular_file(is_unknown)) continue;
    if (const auto begin = begin_of_part(recording, file)) parts.push_back({file, *begin});
  }
  std::ranges::sort(parts, {}, &RecordingPart::begin);
  return parts;
}

std::vector<std::filesystem::path> recording_files(const std::filesystem::path& recording) {
  std::vector<std::filesystem::path> files;
  for (const RecordingPart& part : completed_parts(recording)) files.push_back(part.file);
  std::error_code is_not_there;
  if (std::filesystem::exists(recording, is_not_there)) files.push_back(recording);
  return files;
}

bool recording_exists(const std::filesystem::path& recording) {
  std::error_code is_unknown;
  return std::filesystem::exists(recording, is_unknown) || !completed_parts(recording).empty();
}

}  // namespace yuragi::drivers::windlog
