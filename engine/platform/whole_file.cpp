#include "engine/platform/whole_file.hpp"

#include <algorithm>
#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "engine/platform/descriptor.hpp"

namespace yuragi::platform {

namespace {

constexpr std::size_t kGrowBy_bytes = 4096;

FailureError cannot_create(const std::string& message) {
  return FailureError({message, FailureKind::kCannotCreate});
}

std::string size_text(std::size_t bytes) {
  constexpr std::size_t kMegabyte = 1 << 20;
  return bytes < kMegabyte ? std::to_string(bytes) + " bytes" : std::to_string(bytes / kMegabyte) + " MB";
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
    const std::string beside = file_.string().append(suffix);
    if (!std::filesystem::exists(beside, error)) continue;
    throw cannot_create(std::string(name)
                            .append(": is being recorded, or the recorder was killed (")
                            .append(beside)
                            .append(" exists); name another file"));
  }
  const auto folder = file_.parent_path();
  if (!folder.empty() && !std::filesystem::is_directory(folder, error)) {
    throw cannot_create(folder.string() + ": the folder does not exist");
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
  if (const Descriptor written(open(working_path_.c_str(), O_RDONLY | O_CLOEXEC)); written.get() >= 0)
    fsync(written.get());
  std::error_code error;
  std::filesystem::rename(working_path_, file_, error);
  if (error) return Failure{file_.string() + ": " + error.message(), FailureKind::kCannotCreate};
  return {};
}

Result<std::string, Failure> read_whole(const std::filesystem::path& file, std::size_t most_bytes) {
  const auto failure_of = [](int error) {
    if (error == ENOENT) return Failure{"does not exist", FailureKind::kNoInput};
    if (error == EACCES)
      return Failure{"cannot be read; allow it to the user that this program runs as", FailureKind::kNoInput};
    return Failure{"cannot be read: " + std::generic_category().message(error), FailureKind::kNoInput};
  };
  const Descriptor in(open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY));
  if (in.get() < 0) return failure_of(errno);
  struct stat status {};
  if (fstat(in.get(), &status) != 0) return failure_of(errno);
  if (!S_ISREG(status.st_mode))
    return Failure{"is not a regular file, but a folder, a pipe or a device", FailureKind::kNoInput};
  // One byte more than it seems to have: it may grow meanwhile, and files of the kernel have no size.
  std::string text(std::min(most_bytes, static_cast<std::size_t>(status.st_size)) + 1, '\0');
  std::size_t length = 0;
  while (length <= most_bytes) {
    if (length == text.size()) text.resize(std::min(most_bytes + 1, 2 * length + kGrowBy_bytes));
    const ssize_t count = read(in.get(), text.data() + length, text.size() - length);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return failure_of(errno);
    if (count == 0) break;
    length += static_cast<std::size_t>(count);
  }
  if (length > most_bytes)
    return Failure{"is too large; allowed: up to " + size_text(most_bytes), FailureKind::kBadData};
  text.resize(length);
  return {boost::system::in_place_value, std::move(text)};
}

Result<void, Failure> write_whole(const std::filesystem::path& file, std::string_view text,
                                  std::optional<std::filesystem::perms> permissions) {
  OutputFile output(file, true);
  const auto fail = [&file](const std::string& what) {
    return Failure{file.string() + ": " + what, FailureKind::kCannotCreate};
  };
  const Descriptor out(open(output.working_path().c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
  if (out.get() < 0) return fail("cannot be written: " + std::generic_category().message(errno));
  if (permissions && fchmod(out.get(), static_cast<mode_t>(*permissions)) != 0)
    return fail("its permissions cannot be set: " + std::generic_category().message(errno));
  while (!text.empty()) {
    const ssize_t count = write(out.get(), text.data(), text.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return fail("cannot be written: " + std::generic_category().message(errno));
    text.remove_prefix(static_cast<std::size_t>(count));
  }
  return output.commit();
}

}  // namespace yuragi::platform
