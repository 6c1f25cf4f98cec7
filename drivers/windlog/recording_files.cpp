#include "drivers/windlog/recording_files.hpp"

#include <algorithm>
#include <mutex>
#include <string>
#include <string_view>

#include "drivers/windlog/format.hpp"
#include "drivers/windlog/recording_parts.hpp"

namespace yuragi::drivers::windlog {
namespace {

std::filesystem::path beside(const std::filesystem::path& file, std::string_view suffix) {
  return file.string() + std::string(suffix);
}

void rename_what_is_beside(const std::filesystem::path& from, const std::filesystem::path& to) {
  for (const std::string_view suffix : kSideSuffixes) {
    std::error_code is_not_there;
    std::filesystem::rename(beside(from, suffix), beside(to, suffix), is_not_there);
  }
}

bool is_there(const std::filesystem::path& file) {
  std::error_code is_unknown;
  return std::filesystem::exists(file, is_unknown) || is_unknown;
}

/// The part beside which this file was to lie, by its name; empty for any other file.
std::filesystem::path part_of_side_file(const std::filesystem::path& recording, const std::filesystem::path& file) {
  const std::string name = file.string();
  for (const std::string_view suffix : kSideSuffixes) {
    if (!name.ends_with(suffix)) continue;
    std::filesystem::path part = name.substr(0, name.size() - suffix.size());
    if (begin_of_part(recording, part)) return part;
  }
  return {};
}

}  // namespace

std::shared_mutex& recording_names() {
  static std::shared_mutex names;
  return names;
}

std::error_code rename_recording(const std::filesystem::path& from, const std::filesystem::path& to) {
  const std::lock_guard names(recording_names());
  rename_what_is_beside(from, to);
  std::error_code error;
  std::filesystem::rename(from, to, error);
  if (error) rename_what_is_beside(to, from);
  return error;
}

bool is_free_name(const std::filesystem::path& file) {
  return !is_there(file) && std::ranges::none_of(kSideSuffixes, [&file](std::string_view suffix) {
    return is_there(beside(file, suffix));
  });
}

bool remove_recording(const std::filesystem::path& file) {
  const std::lock_guard names(recording_names());
  std::error_code error;
  for (const std::string_view suffix : kSideSuffixes) std::filesystem::remove(beside(file, suffix), error);
  return std::filesystem::remove(file, error);
}

void finish_rename_to_part(const std::filesystem::path& recording) {
  const std::lock_guard names(recording_names());
  std::error_code error;
  // A recording that has something beside it was not in the midst of a rename.
  if (!std::filesystem::is_regular_file(recording, error) || is_there(beside(recording, kWalSuffix))) return;
  const std::filesystem::path folder = recording.has_parent_path() ? recording.parent_path() : ".";
  for (auto entry = std::filesystem::directory_iterator(folder, error);
       !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    const auto part = part_of_side_file(recording, recording.parent_path() / entry->path().filename());
    if (part.empty() || is_there(part)) continue;
    std::error_code stays;
    std::filesystem::rename(recording, part, stays);
    return;
  }
}

}  // namespace yuragi::drivers::windlog
