#include "viewer/film/write_all.hpp"

#include <algorithm>
#include <cerrno>
#include <climits>

#include <poll.h>
#include <unistd.h>

namespace yuragi::viewer::film {
namespace {

constexpr int kStopCheck_ms = 100;

}  // namespace

int write_all(int fd, std::span<const std::uint8_t> bytes, const std::atomic<bool>& is_stopping) {
  while (!bytes.empty()) {
    if (is_stopping) return ECANCELED;
    pollfd waiting{.fd = fd, .events = POLLOUT, .revents = 0};
    if (::poll(&waiting, 1, kStopCheck_ms) <= 0) continue;
    // A pipe with any space has space for this many bytes: the call does not wait.
    const ssize_t count = ::write(fd, bytes.data(), std::min<std::size_t>(bytes.size(), PIPE_BUF));
    if (count < 0 && errno != EINTR && errno != EAGAIN) return errno;
    if (count > 0) bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return 0;
}

}  // namespace yuragi::viewer::film
