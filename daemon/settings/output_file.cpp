#include "daemon/settings/output_file.hpp"

#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#include "daemon/settings/exit.hpp"

namespace yuragi {

OutputFile::OutputFile(std::filesystem::path file, bool force, std::span<const std::string_view> side_suffixes)
    : file_(std::move(file)), side_suffixes_(side_suffixes) {
  std::error_code error;
  const std::string name = file_.string();
  // A rename onto a device or a link would replace it.
  if (const auto status = std::filesystem::status(file_, error); std::filesystem::exists(status)) {
    if (std::filesystem::is_directory(status)) throw ExitError(kExitCannotCreate, name + ": is a folder");
    if (!std::filesystem::is_regular_file(status)) {
      throw ExitError(kExitCannotCreate, name + ": is no regular file");
    }
    if (force) file_ = std::filesystem::canonical(file_);
  }
  working_path_ = file_.string() + ".part-" + std::to_string(getpid());
  if (!force && std::filesystem::exists(file_, error)) {
    throw ExitError(kExitCannotCreate, name + ": is there already; --force overwrites it");
  }
  // They would be taken for the new file's.
  for (const std::string_view suffix : side_suffixes_) {
    const std::string beside = file_.string() + std::string(suffix);
    if (!std::filesystem::exists(beside, error)) continue;
    throw ExitError(kExitCannotCreate, name + ": is being recorded, or the recorder was killed (" + beside +
                                           " is there); name another file");
  }
  const auto folder = file_.parent_path();
  if (!folder.empty() && !std::filesystem::is_directory(folder, error)) {
    throw ExitError(kExitCannotCreate, folder.string() + ": there is no such folder");
  }
}

OutputFile::~OutputFile() {
  std::error_code ignored;
  std::filesystem::remove(working_path_, ignored);
  for (const std::string_view suffix : side_suffixes_) {
    std::filesystem::remove(working_path_.string() + std::string(suffix), ignored);
  }
}

void OutputFile::commit() {
  // Its content reaches the disk before its name does.
  if (const int descriptor = open(working_path_.c_str(), O_RDONLY | O_CLOEXEC); descriptor >= 0) {
    fsync(descriptor);
    close(descriptor);
  }
  std::error_code error;
  std::filesystem::rename(working_path_, file_, error);
  if (error) throw ExitError(kExitCannotCreate, file_.string() + ": " + error.message());
}

}  // namespace yuragi
