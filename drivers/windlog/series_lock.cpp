#include "drivers/windlog/series_lock.hpp"

#include <array>
#include <cerrno>
#include <charconv>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace yuragi::drivers::windlog {
namespace {

constexpr mode_t kMode = 0640;  // as a recording
/// A holder removes the file when it ends; a program that opened it before that tries again with the next one.
constexpr int kMaxLockTries = 100;

/// The file that locks a recording; nullopt if its name cannot be looked up.
std::optional<std::filesystem::path> lock_file_of(const std::filesystem::path& recording) {
  std::error_code error;
  const auto absolute = std::filesystem::absolute(recording, error);
  if (error) return std::nullopt;
  const auto followed = std::filesystem::weakly_canonical(absolute, error);
  if (error) return std::nullopt;
  return followed.string() + "-lock";
}

/// Is `descriptor` open at the file that has this name? True if the name cannot be looked up.
bool is_open_at(int descriptor, const std::filesystem::path& file) {
  struct stat opened {};
  struct stat named {};
  if (fstat(descriptor, &opened) != 0) return false;
  if (lstat(file.c_str(), &named) != 0) return errno != ENOENT && errno != ENOTDIR;
  return opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

/// Returns " (process 123)", or an empty text if the file does not contain that.
std::string holder_in(int descriptor) {
  std::array<char, 16> text{};
  const ssize_t size = pread(descriptor, text.data(), text.size(), 0);
  if (size <= 0) return "";
  int process = 0;
  const char* const end = text.data() + size;
  const auto [rest, error] = std::from_chars(text.data(), end, process);
  if (error != std::errc() || rest == end || *rest != '\n' || process <= 0) return "";
  return " (process " + std::to_string(process) + ")";
}

void write_holder(int descriptor) {
  const std::string text = std::to_string(getpid()) + "\n";
  // A full disk does not matter: then the process is not known.
  if (ftruncate(descriptor, 0) != 0 || pwrite(descriptor, text.data(), text.size(), 0) < 0) return;
}

/// Returns 0 or the error; EAGAIN or EACCES if another one has the lock.
int lock_at_once(int descriptor) {
  struct flock whole {};
  whole.l_type = F_WRLCK;
  whole.l_whence = SEEK_SET;
  return fcntl(descriptor, F_OFD_SETLK, &whole) == 0 ? 0 : errno;
}

std::string text_of(int error) {
  return std::system_category().message(error);
}

}  // namespace

Result<SeriesLock, Failure> SeriesLock::take(const std::filesystem::path& recording) {
  const std::filesystem::path file = lock_file_of(recording).value_or(recording.string() + "-lock");
  for (int tries = 0; tries < kMaxLockTries; ++tries) {
    const int descriptor = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, kMode);
    if (descriptor < 0) {
      return Failure{file.string() + ": cannot be opened: " + text_of(errno) +
                     "; check that its folder exists and that this user may write to it"};
    }
    const auto close_and_fail = [descriptor](Failure failure) {
      close(descriptor);
      return failure;
    };
    const int error = lock_at_once(descriptor);
    if (error == EAGAIN || error == EACCES) {
      return close_and_fail({"another program" + holder_in(descriptor) + " records to " + recording.string() +
                                 ": end it, or choose another file",
                             FailureKind::kUnavailable});
    }
    const bool has_no_locks = error == ENOLCK || error == ENOSYS || error == EOPNOTSUPP;
    if (error != 0 && !has_no_locks) return close_and_fail({file.string() + ": cannot be locked: " + text_of(error)});
    if (is_open_at(descriptor, file)) {
      write_holder(descriptor);
      return SeriesLock(file, descriptor, error == 0);
    }
    close(descriptor);
  }
  return Failure{file.string() + ": another program removes it repeatedly; stop that program"};
}

SeriesLock::SeriesLock(SeriesLock&& other) noexcept
    : file_(std::move(other.file_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      is_effective_(other.is_effective_) {}

SeriesLock& SeriesLock::operator=(SeriesLock&& other) noexcept {
  std::swap(file_, other.file_);
  std::swap(descriptor_, other.descriptor_);
  std::swap(is_effective_, other.is_effective_);
  return *this;
}

SeriesLock::~SeriesLock() {
  if (descriptor_ < 0) return;
  // Removed before it is released, and only if it is the locked one, so that no other program's lock is lost.
  if (is_open_at(descriptor_, file_)) unlink(file_.c_str());
  close(descriptor_);
}

bool SeriesLock::is_of(const std::filesystem::path& recording) const {
  return lock_file_of(recording).value_or(file_) == file_ && is_open_at(descriptor_, file_);
}

}  // namespace yuragi::drivers::windlog
