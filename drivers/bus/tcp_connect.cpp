// libmodbus connects by itself, but nothing can end its waiting; hence this.
#include "drivers/bus/tcp_connect.hpp"

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <memory>
#include <utility>

#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

namespace yuragi {
namespace {

using ConnectClock = std::chrono::steady_clock;

std::string reason(int error) {
  return std::generic_category().message(error);
}

/// Waits until the connection that was begun is there. 0, or why it is not.
int finish_connecting(int socket, ConnectClock::time_point deadline, const WakeEvent& wake) {
  std::array<pollfd, 2> waits = {pollfd{socket, POLLOUT, 0}, pollfd{wake.descriptor(), POLLIN, 0}};
  const auto left_ms = std::chrono::ceil<std::chrono::milliseconds>(deadline - ConnectClock::now()).count();
  if (left_ms <= 0 || poll(waits.data(), waits.size(), static_cast<int>(left_ms)) <= 0) return ETIMEDOUT;
  if (waits[1].revents != 0) return ECANCELED;
  int error = 0;
  socklen_t size = sizeof error;
  return getsockopt(socket, SOL_SOCKET, SO_ERROR, &error, &size) == 0 ? error : errno;
}

/// A socket that is connected to one address, or why there is none.
std::pair<int, int> connect_to(const addrinfo& address, ConnectClock::time_point deadline, const WakeEvent& wake) {
  const int socket = ::socket(address.ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (socket < 0) return {-1, errno};
  int error = connect(socket, address.ai_addr, address.ai_addrlen) == 0 ? 0 : errno;
  if (error == EINPROGRESS) error = finish_connecting(socket, deadline, wake);
  if (error != 0) {
    ::close(socket);
    return {-1, error};
  }
  const int yes = 1;
  setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  fcntl(socket, F_SETFL, fcntl(socket, F_GETFL) & ~O_NONBLOCK);
  return {socket, 0};
}

}  // namespace

Result<int, Failure> connect_tcp(const std::string& host, std::uint16_t port, Nanoseconds timeout,
                                 const WakeEvent& wake) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (const int error = getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found); error != 0) {
    return Failure{gai_strerror(error)};
  }
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> addresses(found, freeaddrinfo);

  // A name may have several addresses; the first that answers will do.
  const auto deadline = ConnectClock::now() + timeout;
  int last_error = EADDRNOTAVAIL;
  for (const addrinfo* address = found; address != nullptr; address = address->ai_next) {
    const auto [socket, error] = connect_to(*address, deadline, wake);
    if (socket >= 0) return socket;
    last_error = error;
    if (error == ECANCELED) break;
  }
  return Failure{reason(last_error)};
}

}  // namespace yuragi
