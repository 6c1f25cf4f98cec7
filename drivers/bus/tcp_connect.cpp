// In place of libmodbus's own connect, whose wait cannot be interrupted.
#include "drivers/bus/tcp_connect.hpp"

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

namespace yuragi::drivers::bus {
namespace {

using TcpEndpoint = boost::asio::ip::tcp::endpoint;

/// The look-up does not know the interruption, which is checked this often.
constexpr Nanoseconds kLookupSlice = std::chrono::milliseconds(50);

Result<std::vector<TcpEndpoint>, Failure> look_up(HostLookup& host, Nanoseconds timeout,
                                                  const Interruption& interruption) {
  for (Nanoseconds waited{0};; waited += kLookupSlice) {
    auto endpoints = host.find(std::min(kLookupSlice, timeout));
    if (endpoints || !host.is_under_way() || waited >= timeout || interruption.is_set()) return endpoints;
  }
}

void set_socket_options(int socket) {
  const auto set = [socket](int level, int option, int value) {
    setsockopt(socket, level, option, &value, sizeof value);
  };
  set(IPPROTO_TCP, TCP_NODELAY, 1);
  set(SOL_SOCKET, SO_KEEPALIVE, 1);
  set(IPPROTO_TCP, TCP_KEEPIDLE, 10);
  set(IPPROTO_TCP, TCP_KEEPINTVL, 5);
  set(IPPROTO_TCP, TCP_KEEPCNT, 3);
}

/// 0 as soon as the socket is connected, or why it is not.
int connect_socket(int socket, const TcpEndpoint& endpoint, Nanoseconds timeout, const Interruption& interruption) {
  if (::connect(socket, endpoint.data(), static_cast<socklen_t>(endpoint.size())) == 0) return 0;
  if (errno != EINPROGRESS) return errno;
  switch (interruption.wait(socket, WaitFor::kWritable, timeout)) {
    case WaitEnd::kInterrupted:
      return ECANCELED;
    case WaitEnd::kTimeout:
      return ETIMEDOUT;
    case WaitEnd::kReady:
      break;
  }
  int error = 0;
  socklen_t size = sizeof error;
  return getsockopt(socket, SOL_SOCKET, SO_ERROR, &error, &size) == 0 ? error : errno;
}

/// A socket that is connected to one address, or why there is none.
std::pair<int, int> connected_socket(const TcpEndpoint& endpoint, Nanoseconds timeout,
                                     const Interruption& interruption) {
  const int socket = ::socket(endpoint.protocol().family(), SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (socket < 0) return {-1, errno};
  if (const int error = connect_socket(socket, endpoint, timeout, interruption); error != 0) {
    ::close(socket);
    return {-1, error};
  }
  set_socket_options(socket);
  fcntl(socket, F_SETFL, fcntl(socket, F_GETFL) & ~O_NONBLOCK);
  return {socket, 0};
}

}  // namespace

Result<int, Failure> connect_tcp(HostLookup& host, Nanoseconds timeout, const Interruption& interruption) {
  const auto endpoints = look_up(host, timeout, interruption);
  if (!endpoints) return endpoints.error();

  // The addresses share the time, so that one that swallows everything leaves some to the next.
  int last_error = EADDRNOTAVAIL;
  for (const TcpEndpoint& endpoint : *endpoints) {
    const auto [socket, error] =
        connected_socket(endpoint, timeout / static_cast<std::int64_t>(endpoints->size()), interruption);
    if (socket >= 0) return socket;
    last_error = error;
    if (error == ECANCELED) break;
  }
  return Failure{std::generic_category().message(last_error)};
}

}  // namespace yuragi::drivers::bus
