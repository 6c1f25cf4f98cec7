#include "daemon/tools/doctor/local_port.hpp"

#include <cerrno>
#include <memory>
#include <system_error>

#include <netdb.h>
#include <sys/socket.h>
#include <unistd.h>

#include "engine/base/address.hpp"

namespace yuragi::daemon::tools::doctor {
namespace {

/// Binds a socket there, as the daemon would, and closes it again: 0, or why not. `reuses_address`: SO_REUSEADDR.
int bind_error(const addrinfo& info, bool reuses_address) {
  const int socket = ::socket(info.ai_family, info.ai_socktype | SOCK_CLOEXEC, info.ai_protocol);
  if (socket < 0) return errno;
  const int yes = 1;
  if (reuses_address) setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  int error = bind(socket, info.ai_addr, info.ai_addrlen) == 0 ? 0 : errno;
  if (error == 0 && info.ai_socktype == SOCK_STREAM && listen(socket, 1) != 0) error = errno;
  close(socket);
  return error;
}

std::string local_trouble(const std::string& text, int socket_type, bool reuses_address, int& error) {
  const bool has_host = !text.starts_with(':');
  const auto address = parse_address(has_host ? text : "0.0.0.0" + text);
  if (!address) return address.error().message;
  addrinfo hints{};
  hints.ai_socktype = socket_type;
  hints.ai_flags = AI_NUMERICSERV | AI_PASSIVE;
  addrinfo* found = nullptr;
  const std::string port = std::to_string(address->port);
  if (const int fault = getaddrinfo(address->host.c_str(), port.c_str(), &hints, &found); fault != 0)
    return gai_strerror(fault);
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> owner(found, freeaddrinfo);
  error = bind_error(*found, reuses_address);
  return error == 0 ? std::string() : std::generic_category().message(error);
}

}  // namespace

std::string udp_trouble(const std::string& address, bool is_shared) {
  int error = 0;
  return local_trouble(address, SOCK_DGRAM, is_shared, error);
}

std::string listen_trouble(const std::string& address, bool& is_in_use) {
  int error = 0;
  std::string trouble = local_trouble(address, SOCK_STREAM, true, error);
  is_in_use = error == EADDRINUSE;
  return trouble;
}

}  // namespace yuragi::daemon::tools::doctor
