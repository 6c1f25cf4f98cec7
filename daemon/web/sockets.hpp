#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "daemon/http/server.hpp"
#include "daemon/stream/client_admission.hpp"
#include "daemon/stream/transport.hpp"
#include "daemon/values/moment.hpp"
#include "daemon/web/moment_text.hpp"
#include "engine/base/time.hpp"

namespace boost::asio {
class io_context;
}

namespace yuragi::daemon::web {

struct SocketLimits {
  /// 64 pages and 20 pictures, and some to spare.
  stream::AdmissionLimits places = {.max_clients = 96, .max_clients_per_address = 8};
  /// A client that sends nothing for half of this is pinged; one that does not answer has to go.
  Nanoseconds silent_after = std::chrono::seconds(30);
  Nanoseconds stuck_after = std::chrono::seconds(5);   ///< reading nothing of what is sent
  Nanoseconds wish_within = std::chrono::seconds(10);  ///< for something
  /// Of a connection, in the kernel: what waits there is old. It grows with the client's frames.
  std::size_t send_buffer_bytes = 64UL << 10;
  Nanoseconds check_every = std::chrono::milliseconds(250);  ///< how often the limits are checked
};

/// The WebSockets of the web server (I. Fette and A. Melnikov, RFC 6455, "The WebSocket Protocol", 2011). A client
/// sends what it wants (SocketWish as JSON, or the stream's Subscribe without its size prefix as a binary message) and
/// is sent the newest of it: the wind and the state as texts, the stream's messages without their size prefix as binary
/// ones. One message is in flight and one of each kind waits behind it, which a newer one replaces; nobody waits for a
/// client. What a client sends is hostile until decoded: it is refused with a reason in the closing frame.
///
/// All work is done on the thread that runs `io`, which must outlive this object. Thread-safe: wants_wind(),
/// wants_frames() and client_count() only.
class Sockets {
 public:
  struct Settings {
    SocketLimits limits = {};
    wire::Hello hello = {};  ///< the first of the stream's messages; a client that wants its rate or more gets all
    /// Returns true for the token of the installation. Empty: there is none.
    std::function<bool(const std::string& token)> is_token = {};
  };
  /// Who opens one.
  struct Visitor {
    bool is_trusted = false;                            ///< gets what clients of this machine get
    std::optional<std::string> session = std::nullopt;  ///< that let it in
    std::string address = {};                           ///< for the log
  };

  Sockets(boost::asio::io_context& io, Settings settings);
  ~Sockets();
  Sockets(const Sockets&) = delete;
  Sockets& operator=(const Sockets&) = delete;

  /// Returns why there is no place for a client; nullopt: there is one.
  std::optional<std::string> refusal(const stream::Peer& client) const;
  /// Answers the request and serves the client from then on.
  void open(http::Upgrade& upgrade, Visitor visitor);

  bool wants_wind() const noexcept;
  bool wants_frames() const noexcept;
  bool wants_status() const noexcept;
  std::size_t client_count() const noexcept;

  void publish_moment(std::shared_ptr<const values::Moment> moment);
  void publish_frame(stream::SharedBytes frame);
  void publish_scenes(stream::SharedBytes scenes);
  /// As Transport::publish_sensors().
  void publish_sensors(stream::SharedBytes here, stream::SharedBytes elsewhere);
  /// The state as JSON, for clients that are trusted and for others. Null: there is none.
  void publish_status(SharedText here, SharedText elsewhere);

  /// Disconnects the clients of a session that has ended.
  void end_session(const std::string& id);

  /// Disconnects all. A second call does nothing.
  void close();

 private:
  class Server;  // keeps Beast's WebSockets, which are slow to compile, in one file
  std::shared_ptr<Server> server_;
};

}  // namespace yuragi::daemon::web
