#pragma once

#include <functional>
#include <string_view>

#include "daemon/stream/client_queue.hpp"
#include "daemon/stream/transport.hpp"

namespace boost::asio {
class io_context;
}

namespace yuragi::daemon::stream {

struct TcpStreamSettings {
  wire::Hello hello;             ///< the first message to every client
  wire::Scenes scenes;           ///< the second message to clients that subscribe to poses
  std::size_t max_clients = 32;  ///< further ones are refused with a Hello that says so
  /// Carries out a client's request about scenes or recordings and returns the reply; `is_local`: the client is on this
  /// machine. Empty: every request is refused.
  std::function<wire::ControlReply(const wire::Control& control, bool is_local)> on_control = {};
  ClientLimits limits = {};
  Nanoseconds check_every = std::chrono::milliseconds(250);  ///< how often the limits are checked
  std::function<MonoTime()> now = steady_now;                ///< the clock of the limits

  static MonoTime steady_now() { return std::chrono::time_point_cast<Nanoseconds>(std::chrono::steady_clock::now()); }
};

/// The stream of engine/wire/pose.fbs over TCP: size-prefixed messages to any number of clients.
///
/// Each client gets a Hello, subscribes once, and is then sent the newest messages of that kind (ClientQueue). After
/// that it may send Controls, each of which gets a reply. A client that sends anything else, does not subscribe, or
/// stops reading is disconnected, and that is logged. Send buffers are kept small, so that a slow client gets new
/// frames.
///
/// All work is done in callbacks on the thread that runs `io`, which must outlive this object. Thread-safe: no.
class TcpStream final : public Transport {
 public:
  /// Listens on `listen` ("HOST:PORT"; port 0 takes any free one). Throws FailureError (kUnavailable) where
  /// that is not possible.
  TcpStream(boost::asio::io_context& io, std::string_view listen, TcpStreamSettings settings);
  ~TcpStream() override;

  /// Where it listens: "127.0.0.1:7410".
  std::string local_endpoint() const;

  std::string name() const override { return "tcp " + local_endpoint(); }
  void publish(SharedBytes frame) override;
  void publish_sensors(SharedBytes sensors) override;
  std::size_t client_count() const override;

  /// Has any client subscribed to the raw messages of this sensor's device?
  bool wants_trace(std::string_view sensor) const;
  /// Sends one to these clients. A client that reads too slowly misses some; the next one counts them.
  void publish_trace(const wire::RawTrace& trace);

  void close() override;

  /// How many clients were disconnected because they stopped reading.
  std::uint64_t stuck_clients() const;

 private:
  class Server;  // keeps Asio, which is slow to compile, in one file
  std::shared_ptr<Server> server_;
};

}  // namespace yuragi::daemon::stream
