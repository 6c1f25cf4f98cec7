#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "simulators/modbus/modbus_protocol.hpp"

namespace yuragi::simulators::modbus {

/// The connection of a simulated Modbus bus: a TCP port or a serial one.
class Port {
 public:
  /// A request, and which client sent it.
  struct ClientRequest {
    int client;
    SlaveRequest request;
  };

  virtual ~Port() = default;

  virtual bool is_rtu() const = 0;
  /// The name by which others open it: "127.0.0.1:1502", "/dev/pts/3".
  virtual std::string name() const = 0;

  virtual std::vector<int> descriptors() const = 0;
  /// The requests that have arrived on those of the descriptors that can be read. Never waits.
  virtual std::vector<ClientRequest> receive(std::span<const int> ready) = 0;
  /// Sends bytes to a client; does nothing if it has disconnected.
  virtual void send(int client, std::span<const std::uint8_t> bytes) = 0;

  /// Closes all connections and the port.
  virtual void leave() = 0;
  /// Opens the port again under the same name, if it was closed and that is possible.
  virtual void come_back() = 0;
};

/// Listens at once; port 0 takes a free one. Serves any number of clients. Throws std::runtime_error for an address
/// that cannot be listened on.
std::unique_ptr<Port> make_modbus_tcp_port(const std::string& host, std::uint16_t port);

/// A pseudo terminal, and, if it is not empty, a `link` to it. Throws std::system_error.
std::unique_ptr<Port> make_modbus_rtu_port(const std::string& link);

}  // namespace yuragi::simulators::modbus
