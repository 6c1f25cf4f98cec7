#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "daemon/feeds/osc_addresses.hpp"
#include "daemon/http/server.hpp"
#include "daemon/stream/client_admission.hpp"
#include "daemon/values/moment.hpp"

namespace yuragi::daemon::feeds {

/// The WebSockets of an OSCQuery server: a client names addresses by LISTEN and IGNORE, and is sent each value that
/// changes, as an OSC message in a binary frame. A client that does not keep up misses values, never the newest; one
/// that takes nothing for 5 s is disconnected. What clients send is hostile: a text that is not a command ends the
/// connection, binary frames (values to set) have no effect, and commands that come faster than they are taken wait in
/// the network.
///
/// All work is done in send() and by the sockets' io_context, on the same thread. Thread-safe: no.
class OscQuerySockets {
 public:
  OscQuerySockets();
  ~OscQuerySockets();

  /// Why one more client cannot connect; nullopt: it can.
  std::optional<std::string> refusal(const stream::Peer& client) const;
  /// Takes over a connection that has asked for a WebSocket.
  void open(http::Upgrade& upgrade);

  /// Replaces the addresses: clients get PATH_CHANGED, and still listen to those that stay.
  void set_addresses(std::shared_ptr<const std::vector<OscAddress>> addresses);

  /// Sends what has changed, sensors' values ten times a second. Call it once a tick.
  void send(const values::Moment& moment, values::Wind wind);

  std::size_t clients() const noexcept;
  std::uint64_t messages() const noexcept;
  std::uint64_t bytes() const noexcept;
  std::optional<MonoTime> last_sent() const noexcept;

 private:
  class Client;
  struct Shared;
  std::shared_ptr<Shared> shared_;
};

}  // namespace yuragi::daemon::feeds
