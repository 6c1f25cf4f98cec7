#pragma once

#include <functional>
#include <string_view>

#include "daemon/stream/client_queue.hpp"
#include "daemon/stream/transport.hpp"

namespace boost::asio {
class io_context;
}

namespace yuragi {

struct TcpStreamSettings {
  wire::Hello hello;             ///< what every client is greeted with
  wire::Scenes scenes;           ///< what those who ask for poses get first
  std::size_t max_clients = 32;  ///< more are told so, and let go
  /// Answers a client's wish to show or hide a scene, or to control a recording; `is_local`: it asks from this machine.
  /// None: nothing is taken.
  std::function<wire::ControlReply(const wire::Control& control, bool is_local)> on_control = {};
  ClientLimits limits = {};
  Nanoseconds check_every = std::chrono::milliseconds(250);  ///< how often the limits are looked at
  std::function<MonoTime()> now = steady_now;                ///< what the limits are measured with

  static MonoTime steady_now() { return std::chrono::time_point_cast<Nanoseconds>(std::chrono::steady_clock::now()); }
};

/// The stream of engine/wire/pose.fbs over TCP: size-prefixed messages to any number of clients.
///
/// Each client is greeted, says once what it wants, and gets the newest of it from then on (ClientQueue). After that it
/// may send Controls, each of which is answered. One that sends anything else, never says what it wants, or stops
/// reading is let go and logged. Send buffers are kept short, so that what a slow client sees is new.
///
/// Everything happens in callbacks on the thread that runs `io`, which must outlive this object. Thread-safe: no.
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

  /// Does a client want to see the messages to and from this sensor's device?
  bool wants_trace(std::string_view sensor) const;
  /// Sends one to those who do. A client that reads too slowly misses some, and is told how many.
  void publish_trace(const wire::RawTrace& trace);

  void close() override;

  /// Clients let go because they stopped reading.
  std::uint64_t stuck_clients() const;

 private:
  class Server;  // keeps Asio, which is slow to compile, in one file
  std::shared_ptr<Server> server_;
};

}  // namespace yuragi
