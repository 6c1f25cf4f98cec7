#include "daemon/http/file_body.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <system_error>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#include "engine/base/contain.hpp"

namespace yuragi::daemon::http {
namespace {

constexpr std::uint64_t kMaxMove_bytes = 1UL << 20;

/// Returns when all has been moved, the file cannot be read, or nobody reads the pipe any more.
void move(int file, std::uint64_t bytes, int pipe) {
  sigset_t broken_pipe;
  sigemptyset(&broken_pipe);
  sigaddset(&broken_pipe, SIGPIPE);
  pthread_sigmask(SIG_BLOCK, &broken_pipe, nullptr);
  loff_t place = 0;
  while (bytes > 0) {
    const ssize_t moved = splice(file, &place, pipe, nullptr, std::min(bytes, kMaxMove_bytes), 0);
    if (moved < 0 && errno == EINTR) continue;
    if (moved <= 0) return;
    bytes -= static_cast<std::uint64_t>(moved);
  }
}

}  // namespace

FileBody::FileBody(std::shared_ptr<const platform::Descriptor> file, std::uint64_t bytes)
    : file_(std::move(file)), bytes_(bytes) {}

int FileBody::begin() const {
  std::array<int, 2> ends{-1, -1};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "a pipe");
  platform::Descriptor out(ends[0]);
  auto in = std::make_shared<platform::Descriptor>(ends[1]);
  std::thread([file = file_, bytes = bytes_, in = std::move(in)] {
    contain("reading a file that is sent", [&] { move(file->get(), bytes, in->get()); });
  }).detach();
  return out.release();
}

}  // namespace yuragi::daemon::http
