#include "daemon/web/recording_list.hpp"

#include <chrono>
#include <system_error>
#include <utility>

#include <nlohmann/json.hpp>

#include "drivers/windlog/recording_parts.hpp"
#include "drivers/windlog/stored_file.hpp"
#include "engine/base/json_text.hpp"

namespace yuragi::daemon::web {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

std::optional<RecordingFile> regular_file(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return std::nullopt;
  const std::uintmax_t bytes = fs::file_size(file, error);
  if (error) return std::nullopt;
  return RecordingFile{.file = file, .bytes = bytes};
}

void add_span(RecordingFile& recording) {
  const auto opened = drivers::windlog::open_stored_file(recording.file, {});
  if (!opened || opened->readings->sessions.empty()) return;
  recording.first = opened->readings->sessions.front().first.utc;
  recording.last = opened->readings->sessions.back().last.utc;
}

ordered_json seconds_or_null(const std::optional<UtcTime>& moment) {
  if (!moment) return nullptr;
  return std::chrono::floor<std::chrono::seconds>(*moment).time_since_epoch().count();
}

}  // namespace

std::vector<RecordingFile> list_recordings(const fs::path& recording, KnownRecordings& known) {
  std::vector<RecordingFile> files;
  if (recording.empty()) return files;
  if (auto written = regular_file(recording)) {
    written->is_written = true;
    add_span(*written);
    files.push_back(std::move(*written));
  }
  const auto parts = drivers::windlog::completed_parts(recording);
  for (auto part = parts.rbegin(); part != parts.rend() && files.size() < kMaxListedRecordings; ++part) {
    auto file = regular_file(part->file);
    if (!file) continue;  // deleted meanwhile
    const auto learnt = known.find(part->file);
    if (learnt != known.end() && learnt->second.bytes == file->bytes) {
      file = learnt->second;
    } else {
      add_span(*file);
    }
    files.push_back(std::move(*file));
  }
  known.clear();
  for (const RecordingFile& file : files) {
    if (!file.is_written) known.emplace(file.file, file);
  }
  return files;
}

std::optional<RecordingFile> recording_named(const fs::path& recording, std::string_view name) {
  if (recording.empty()) return std::nullopt;
  if (recording.filename().string() == name) {
    auto written = regular_file(recording);
    if (written) written->is_written = true;
    return written;
  }
  for (const auto& part : drivers::windlog::completed_parts(recording)) {
    if (part.file.filename().string() == name) return regular_file(part.file);
  }
  return std::nullopt;
}

std::string recordings_json(const std::vector<RecordingFile>& recordings) {
  ordered_json list = ordered_json::array();
  for (const RecordingFile& one : recordings) {
    list.push_back({{"name", one.file.filename().string()},
                    {"bytes", one.bytes},
                    {"first_s", seconds_or_null(one.first)},
                    {"last_s", seconds_or_null(one.last)},
                    {"is_written", one.is_written}});
  }
  return json_text(ordered_json{{"recordings", std::move(list)}}, 2) + "\n";
}

}  // namespace yuragi::daemon::web
