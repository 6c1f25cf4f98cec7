#include "daemon/settings/output_file.hpp"

#include <fstream>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

namespace yuragi::daemon::settings {

namespace {

FailureError cannot_create(const std::string& message) {
  return FailureError({message, FailureKind::kCannotCreate});
}

}  // namespace

OutputFile::OutputFile(std::filesystem::path file, bool force, std::span<const std::string_view> side_suffixes)
    : file_(std::move(file)), side_suffixes_(side_suffixes) {
  std::error_code error;
  const std::string name = file_.string();
  // Renaming onto a device or a link would replace it.
  if (const auto status = std::filesystem::status(file_, error); std::filesystem::exists(status)) {
    if (std::filesystem::is_directory(status)) throw cannot_create(name + ": is a folder");
    if (!std::filesystem::is_regular_file(status)) throw cannot_create(name + ": is not a regular file");
    if (!force) throw cannot_create(name + ": exists already; --force overwrites it");
    file_ = std::filesystem::canonical(file_);
  }
  working_path_ = file_.string() + ".part-" + std::to_string(getpid());
  // SQLite would take them for the new file's.
  for (const std::string_view suffix : side_suffixes_) {
    const std::string beside = file_.string() + std::string(suffix);
    if (!std::filesystem::exists(beside, error)) continue;
    throw cannot_create(name + ": is being recorded, or the recorder was killed (" + beside +
                        " exists); name another file");
  }
  const auto folder = file_.parent_path();
  if (!folder.empty() && !std::filesystem::is_directory(folder, error)) {
    throw cannot_create(folder.string() + ": there is no such folder");
  }
}

OutputFile::~OutputFile() {
  std::error_code ignored;
  std::filesystem::remove(working_path_, ignored);
  for (const std::string_view suffix : side_suffixes_) {
    std::filesystem::remove(working_path_.string() + std::string(suffix), ignored);
  }
}

Result<void, Failure> OutputFile::commit() {
  // The content must reach the disk before the name does.
  if (const int descriptor = open(working_path_.c_str(), O_RDONLY | O_CLOEXEC); descriptor >= 0) {
    fsync(descriptor);
    close(descriptor);
  }
  std::error_code error;
  std::filesystem::rename(working_path_, file_, error);
  if (error) return Failure{file_.string() + ": " + error.message(), FailureKind::kCannotCreate};
  return {};
}

Result<void, Failure> write_whole(const std::filesystem::path& file, std::string_view text,
                                  std::optional<std::filesystem::perms> permissions) {
  OutputFile output(file, true);
  std::ofstream out(output.working_path(), std::ios::binary);
  if (std::error_code error; permissions) {
    std::filesystem::permissions(output.working_path(), *permissions, error);
    if (error) return Failure{file.string() + ": its permissions cannot be set: " + error.message()};
  }
  out << text;
  out.close();
  if (!out) return Failure{file.string() + ": could not be written; is the disk full, or the folder not writable?"};
  return output.commit();
}

}  // namespace yuragi::daemon::settings
