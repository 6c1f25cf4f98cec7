#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <thread>
#include <vector>

#include <arpa/inet.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>

#include "tests/support/descriptor.hpp"

namespace yuragi {

/// A TCP server on the loopback that answers whatever it reads with whatever the test says: one client at a time, on a
/// thread of its own, for as long as it lives.
class ScriptedServer {
 public:
  using Bytes = std::vector<std::uint8_t>;
  /// The answer to a request; empty: none; nothing: the connection is closed. Runs on the server's thread.
  using Script = std::function<std::optional<Bytes>(const Bytes& request)>;

  explicit ScriptedServer(Script script, std::uint16_t port = 0)
      : script_(std::move(script)), listener_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)), wake_(eventfd(0, 0)) {
    const int yes = 1;
    setsockopt(listener_.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(port);
    socklen_t size = sizeof address;
    auto* const generic = reinterpret_cast<sockaddr*>(&address);
    if (bind(listener_.get(), generic, size) != 0 || listen(listener_.get(), 8) != 0 ||
        getsockname(listener_.get(), generic, &size) != 0) {
      throw std::runtime_error("no port on the loopback");
    }
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] { serve(); });
  }
  ~ScriptedServer() {
    eventfd_write(wake_.get(), 1);
    thread_.join();
  }
  ScriptedServer(const ScriptedServer&) = delete;
  ScriptedServer& operator=(const ScriptedServer&) = delete;

  std::uint16_t port() const { return port_; }

 private:
  void serve() {
    for (Descriptor client;;) {
      std::array<pollfd, 3> waits = {
          {{wake_.get(), POLLIN, 0}, {client.get() < 0 ? listener_.get() : -1, POLLIN, 0}, {client.get(), POLLIN, 0}}};
      poll(waits.data(), waits.size(), -1);
      if (waits[0].revents != 0) return;
      if (waits[1].revents != 0) client = Descriptor(accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC));
      if (waits[2].revents != 0 && !reply_to(client.get())) client.reset();
    }
  }

  bool reply_to(int client) {
    Bytes request(512);
    const ssize_t size = recv(client, request.data(), request.size(), 0);
    if (size <= 0) return false;
    request.resize(static_cast<std::size_t>(size));
    const auto bytes = script_(request);
    if (!bytes) return false;
    return bytes->empty() || send(client, bytes->data(), bytes->size(), MSG_NOSIGNAL) >= 0;
  }

  Script script_;
  Descriptor listener_;
  Descriptor wake_;
  std::uint16_t port_ = 0;
  std::thread thread_;
};

}  // namespace yuragi
