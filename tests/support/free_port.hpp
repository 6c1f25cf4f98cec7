#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <arpa/inet.h>
#include <sys/socket.h>
#include <sys/un.h>
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

/// Reserves a port among the tests of this machine until this process ends, by the name of a socket that nobody else
/// can have meanwhile (tests/e2e/programs.py: likewise). False where another one has it.
inline bool reserve_port(std::uint16_t port) {
  static std::mutex mutex;
  static std::vector<Descriptor> held;
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  const std::string text = "yuragi-test-port-" + std::to_string(port);
  std::ranges::copy(text, name.sun_path + 1);  // after a zero: no file, gone with its socket
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + text.size());
  Descriptor socket(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  if (bind(socket.get(), reinterpret_cast<const sockaddr*>(&name), size) != 0) return false;
  const std::lock_guard lock(mutex);
  held.push_back(std::move(socket));
  return true;
}

/// A port that is free, and that no other test takes, for a program that has to be told its port, or gives it up and
/// takes it again. It is none of those that the system gives to whoever asks for any (32768 and above).
inline std::uint16_t free_port(int type) {
  constexpr int kFirst = 12'000;
  constexpr int kCount = 20'000;
  constexpr int kBetweenProcesses = 37;
  static std::atomic<int> next = getpid() * kBetweenProcesses % kCount;
  for (int tries = 0; tries < kCount; ++tries) {
    const auto port = static_cast<std::uint16_t>(kFirst + next++ % kCount);
    try {
      const LoopbackPort free(type, port);
      if (reserve_port(port)) return port;
    } catch (const std::runtime_error&) {
      // a program that is no test has it
    }
  }
  throw std::runtime_error("no port on the loopback");
}

}  // namespace yuragi
