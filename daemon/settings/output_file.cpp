#include "daemon/settings/output_file.hpp"

#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

namespace yuragi {

namespace {

FailureError cannot_create(const std::string& message) {
  return FailureError({message, FailureKind::kCannotCreate});
}

}  // namespace

OutputFile::OutputFile(std::filesystem::path file, bool force)
    : file_(std::move(file)), working_path_(file_.string() + ".part-" + std::to_string(getpid())) {
  std::error_code error;
  const std::string name = file_.string();
  if (std::filesystem::is_directory(file_, error)) throw cannot_create(name + ": is a folder");
  if (!force && std::filesystem::exists(file_, error)) {
    throw cannot_create(name + ": exists already; --force overwrites it");
  }
  // SQLite would take a left -wal for the new file's.
  if (std::filesystem::exists(name + "-wal", error)) {
    throw cannot_create(name + ": is being recorded, or the recorder was killed (" + name +
                        "-wal exists); name another file");
  }
  const auto folder = file_.parent_path();
  if (!folder.empty() && !std::filesystem::is_directory(folder, error)) {
    throw cannot_create(folder.string() + ": there is no such folder");
  }
}

OutputFile::~OutputFile() {
  std::error_code ignored;
  for (const char* suffix : {"", "-wal", "-shm", "-journal"}) {
    std::filesystem::remove(working_path_.string() + suffix, ignored);
  }
}

Result<void, Failure> OutputFile::commit() {
  // Its content reaches the disk before its name does.
  if (const int descriptor = open(working_path_.c_str(), O_RDONLY | O_CLOEXEC); descriptor >= 0) {
    fsync(descriptor);
    close(descriptor);
  }
  std::error_code error;
  std::filesystem::rename(working_path_, file_, error);
  if (error) return Failure{file_.string() + ": " + error.message(), FailureKind::kCannotCreate};
  return {};
}

}  // namespace yuragi
