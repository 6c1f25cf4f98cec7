#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "simulators/core/faults.hpp"

namespace yuragi::simulators::text {

/// The transport of a simulated device that sends text. It never waits: what no client reads is lost. Thread-safe: no.
class Wire {
 public:
  virtual ~Wire() = default;

  /// The faults of the transport itself.
  virtual std::span<const core::FaultKind> known_faults() const = 0;
  /// The descriptors on which bytes or new clients arrive.
  virtual std::vector<int> descriptors() const = 0;
  /// The bytes that clients have sent; `ready` are the descriptors that can be read.
  virtual std::string read(std::span<const int> ready) = 0;
  /// Sets what each client gets first. A wire that knows no clients does not send it.
  virtual void greet_with(const std::string& /*bytes*/) {}
  /// From now on a client gets only its greeting until it has sent something. A wire that cannot receive continues to
  /// send.
  virtual void wait_for_clients() {}
  /// Sends the bytes to all clients.
  virtual void write(std::string_view bytes) = 0;

  /// While `is_wanted`, drops its clients and refuses new ones. Only a wire whose protocol can refuse does so.
  virtual void refuse(bool /*is_wanted*/) {}

  /// Closes the port and all connections. A second call does nothing.
  virtual void take_away() = 0;
  /// Opens the port again under the same name. A second call does nothing.
  virtual void bring_back() = 0;

  /// "listening on /dev/pts/3", "listening on 127.0.0.1:10110", "sending to 127.0.0.1:10110".
  virtual std::string place() const = 0;
};

/// A serial port; `link`, if not empty, is the name that it has each time it is plugged in. Throws std::system_error.
std::unique_ptr<Wire> make_pty_wire(const std::string& link);

/// A TCP server; port 0 takes a free one. Throws std::runtime_error if the address cannot be listened on.
std::unique_ptr<Wire> make_tcp_wire(const std::string& host, std::uint16_t port);

struct WebSocketWireOptions {
  std::string host = "127.0.0.1";
  std::uint16_t port = 0;  ///< 0 takes a free one
  std::string path = "/";  ///< requests must begin with this; any other gets HTTP 404
  std::string token = {};  ///< a client without it gets HTTP 401; empty: no token is needed
};

/// A WebSocket server, each message as text. Throws std::runtime_error if the address cannot be listened on.
std::unique_ptr<Wire> make_websocket_wire(const WebSocketWireOptions& options);

/// Datagrams to one address, one for each write. Throws std::runtime_error for a text that is no address.
std::unique_ptr<Wire> make_udp_wire(const std::string& host, std::uint16_t port);

/// A CAN interface of this machine; each write is a frame (`struct can_frame` of linux/can.h). Throws
/// std::runtime_error if it is missing at first.
std::unique_ptr<Wire> make_can_wire(const std::string& interface);

}  // namespace yuragi::simulators::text
