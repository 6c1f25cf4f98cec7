#pragma once

#include <cstdint>
#include <stdexcept>

#include <arpa/inet.h>
#include <sys/socket.h>

#include "tests/support/descriptor.hpp"

namespace yuragi {

/// A socket at a port of the loopback that nobody else has; `type` is SOCK_STREAM or SOCK_DGRAM.
class LoopbackPort {
 public:
  explicit LoopbackPort(int type) : socket_(socket(AF_INET, type | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* const generic = reinterpret_cast<sockaddr*>(&address);
    if (bind(socket_.get(), generic, size) != 0 || getsockname(socket_.get(), generic, &size) != 0) {
      throw std::runtime_error("no port on the loopback");
    }
    port_ = ntohs(address.sin_port);
  }

  std::uint16_t port() const { return port_; }
  int descriptor() const { return socket_.get(); }

 private:
  Descriptor socket_;
  std::uint16_t port_ = 0;
};

/// A port that was free a moment ago, for a program that has to be told its port.
inline std::uint16_t free_port(int type) {
  return LoopbackPort(type).port();
}

}  // namespace yuragi
