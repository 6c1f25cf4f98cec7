// A file that is played once, a file that grows, or a named pipe.
#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "drivers/bus/descriptor_port.hpp"

namespace yuragi::drivers::bus {
namespace {

/// How often a file is checked for new lines: change notification does not work on every file system.
constexpr Nanoseconds kLookInterval = std::chrono::milliseconds(50);

class FileBytePort final : public DescriptorPort {
 public:
  using DescriptorPort::DescriptorPort;
  ~FileBytePort() override { FileBytePort::close(); }
  FileBytePort(const FileBytePort&) = delete;
  FileBytePort& operator=(const FileBytePort&) = delete;

  Result<void, Failure> open() override {
    close();
    if (interruption().is_set()) return Failure{"interrupted"};

    // A pipe that is also open for writing never ends when its writers close it.
    struct stat what {};
    if (stat(address().path.c_str(), &what) != 0) return failure_of(errno);
    if (!S_ISREG(what.st_mode) && !S_ISFIFO(what.st_mode)) {
      return Failure{"cannot read " + address().path +
                     ": it is neither a file nor a named pipe; a serial port needs transport serial"};
    }
    const int access = S_ISFIFO(what.st_mode) ? O_RDWR : O_RDONLY;
    file_ = ::open(address().path.c_str(), access | O_NONBLOCK | O_CLOEXEC);
    if (file_ < 0 || fstat(file_, &what) != 0) return failure_of(errno);
    is_pipe_ = S_ISFIFO(what.st_mode);
    if (!is_pipe_ && !address().is_played) skip_to_last_line();
    return {};
  }

  void close() noexcept override {
    if (file_ >= 0) ::close(std::exchange(file_, -1));
  }

  ByteArrival read(std::span<std::uint8_t> buffer, Nanoseconds timeout) override {
    if (is_pipe_ || file_ < 0) return DescriptorPort::read(buffer, timeout);
    for (;;) {
      if (interruption().is_set()) return {ByteStatus::kInterrupted};
      const ssize_t size = ::read(file_, buffer.data(), buffer.size());
      if (size > 0) return {ByteStatus::kBytes, static_cast<std::size_t>(size)};
      if (size < 0 && errno != EINTR) return {ByteStatus::kLost};
      if (address().is_played) return {ByteStatus::kEnd};
      if (!is_still_there()) return {ByteStatus::kLost};
      if (timeout <= Nanoseconds::zero()) return {ByteStatus::kSilence};

      const Nanoseconds wait = std::min(timeout, kLookInterval);
      timeout -= wait;
      interruption().wait(-1, WaitFor::kReadable, wait);
    }
  }

  /// A file cannot be written to.
  bool write(std::span<const std::uint8_t> /*bytes*/) override { return false; }

 protected:
  int descriptor() noexcept override { return file_; }

 private:
  Failure failure_of(int error) {
    close();
    return Failure{"cannot open " + address().path + " (" + std::generic_category().message(error) +
                   "): check its name, and that this user may read it"};
  }

  /// To the beginning of the line that is being written, so that it is read whole.
  void skip_to_last_line() const {
    std::array<char, 1024> tail{};
    const off_t end = lseek(file_, 0, SEEK_END);
    const off_t begin = std::max<off_t>(0, end - static_cast<off_t>(tail.size()));
    const ssize_t size = pread(file_, tail.data(), tail.size(), begin);
    for (ssize_t at = size; at > 0; --at) {
      if (tail[static_cast<std::size_t>(at - 1)] != '\n') continue;
      lseek(file_, begin + at, SEEK_SET);
      return;
    }
    if (begin == 0) lseek(file_, 0, SEEK_SET);
  }

  /// False once another file has its name. One that was cut short is read from its new beginning on.
  bool is_still_there() const {
    struct stat opened {};
    struct stat named {};
    if (fstat(file_, &opened) != 0 || stat(address().path.c_str(), &named) != 0) return false;
    if (opened.st_size < lseek(file_, 0, SEEK_CUR)) lseek(file_, 0, SEEK_SET);
    return opened.st_ino == named.st_ino && opened.st_dev == named.st_dev;
  }

  int file_ = -1;
  bool is_pipe_ = false;
};

}  // namespace

std::unique_ptr<BytePort> make_file_port(const BytePortAddress& address) {
  return std::make_unique<FileBytePort>(address);
}

}  // namespace yuragi::drivers::bus
