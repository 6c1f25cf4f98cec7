#pragma once

#include <atomic>
#include <cstdint>
#include <stdexcept>

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tests/support/descriptor.hpp"

namespace yuragi {

/// A socket at a port of the loopback that nobody else has; `type` is SOCK_STREAM or SOCK_DGRAM.
class LoopbackPort {
 public:
  /// `port` 0: any. Throws where it is taken.
  explicit LoopbackPort(int type, std::uint16_t port = 0) : socket_(socket(AF_INET, type | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(port);
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

/// A port that was free a moment ago, for a program that has to be told its port, or gives it up and takes it again.
/// It is none of those that the system gives to whoever asks for any (32768 and above), which other tests do all the
/// time; tests that run at the same time begin at different ones.
inline std::uint16_t free_port(int type) {
  constexpr int kFirst = 12'000;
  constexpr int kCount = 20'000;
  constexpr int kBetweenProcesses = 37;
  static std::atomic<int> next = getpid() * kBetweenProcesses % kCount;
  for (int tries = 0; tries < kCount; ++tries) {
    const auto port = static_cast<std::uint16_t>(kFirst + next++ % kCount);
    try {
      return LoopbackPort(type, port).port();
    } catch (const std::runtime_error&) {
      continue;  // somebody has it
    }
  }
  throw std::runtime_error("no port on the loopback");
}

}  // namespace yuragi
