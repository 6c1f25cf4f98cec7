#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "daemon/stream/client_admission.hpp"
#include "daemon/stream/client_queue.hpp"
#include "daemon/stream/log_allowance.hpp"
#include "daemon/stream/transport.hpp"

namespace boost::asio {
class io_context;
}

namespace yuragi::daemon::stream {

struct TcpStreamSettings {
  wire::Hello hello;    ///< the first message to every client
  wire::Scenes scenes;  ///< the second message to clients that subscribe to poses, until others are published
  AdmissionLimits admission = {};  ///< further clients are refused with a Hello that has the reason
  /// Carries out a client's request about scenes or recordings and returns the reply; `is_local`: the client is on this
  /// machine, or has shown the token. Empty: every request is refused.
  std::function<wire::ControlReply(const wire::Control& control, bool is_local)> on_control = {};
  /// Has the configuration read again for a client, and calls `reply` once on this thread, at once or later. Empty:
  /// such a request goes to on_control.
  std::function<void(const wire::ReloadCommand& command, bool is_local,
                     std::function<void(const wire::ControlReply&)> reply)>
      on_reload = {};
  /// Lists and sets values for a client, and calls `reply` in the same way. Empty: such a request goes to on_control.
  std::function<void(const wire::ParameterCommand& command, bool is_local,
                     std::function<void(const wire::ControlReply&)> reply)>
      on_parameters = {};
  /// Why a client may not have raw messages, if so; then the connection ends with that reason. Empty: everybody may.
  std::function<std::optional<std::string>(bool is_local)> raw_refusal = {};
  /// Returns true for the token of the installation. A client that sends it in its Subscribe is trusted, for every
  /// `is_local` above; one that sends a wrong token is disconnected. Empty: there is no token.
  std::function<bool(const std::string& token)> is_token = {};
  /// Clients of this machine are trusted without a token.
  bool trusts_this_machine = true;
  ClientLimits limits = {};
  LogAllowance::Settings log = {};                           ///< how many lines clients may cause in the log
  Nanoseconds check_every = std::chrono::milliseconds(250);  ///< how often the limits are checked
  std::function<MonoTime()> now = steady_now;                ///< the clock of the limits

  /// Returns true if a client at this numeric address, without the port, is on this machine.
  std::function<bool(const std::string& address)> is_of_this_machine = is_loopback;

  /// Loopback, also of an IPv4 client on an IPv6 socket.
  static bool is_loopback(const std::string& address);
  static MonoTime steady_now() { return std::chrono::time_point_cast<Nanoseconds>(std::chrono::steady_clock::now()); }
};

/// How many clients have been turned away since the start.
struct ClientCounts {
  std::uint64_t refused = 0;  ///< at once, because all places were taken
  std::uint64_t stuck = 0;    ///< disconnected because they stopped reading
  std::uint64_t idle = 0;     ///< disconnected because they subscribed to nothing, or not at all
};

/// The stream of engine/wire/pose.fbs over TCP: size-prefixed messages to any number of clients.
///
/// Each client gets a Hello, subscribes once, and is then sent the newest messages of that kind (ClientQueue), thinned
/// out as it asked for (PoseViews, FramePace). When the scenes change, a client that takes new ones gets them before
/// their first frame; another one is disconnected. After that it may send Controls, each of which gets a reply, and
/// Displays. A client that sends anything else, does not subscribe, asks for nothing, or stops reading is disconnected,
/// and that is logged (ClientLog); if it can still read, a second Hello gives it the reason. Who gets a place is
/// decided by admission_refusal(). The kernel asks every 10 s whether a silent client is still there, so that one that
/// vanished without a word is forgotten within a minute. Send buffers are kept small, so that a slow client gets new
/// frames.
///
/// All work is done in callbacks on the thread that runs `io`, which must outlive this object. Thread-safe: no.
class TcpStream final : public Transport {
 public:
  /// Listens on `listen` ("HOST:PORT"; port 0 takes any free one). Throws FailureError (kUnavailable) if
  /// that is not possible.
  TcpStream(boost::asio::io_context& io, std::string_view listen, TcpStreamSettings settings);
  ~TcpStream() override;

  /// Where it listens: "127.0.0.1:7410".
  std::string local_endpoint() const;

  std::string name() const override { return "tcp " + local_endpoint(); }
  void publish(SharedBytes frame) override;
  void publish_scenes(SharedBytes scenes) override;
  void publish_sensors(SharedBytes here, SharedBytes elsewhere) override;
  /// The scenes that were published last, encoded.
  SharedBytes scenes() const;
  std::size_t client_count() const override;
  bool has_untrusted_clients() const override;
  /// The most of all clients' wire::Display.
  std::uint8_t given_up() const;
  /// The client whose clock is farthest from UTC, by its wire::Display. Nullopt: none reports its clock.
  struct ClientClock {
    std::string client;  ///< "192.0.2.7:40116"
    double offset_s = 0.0;
  };
  std::optional<ClientClock> worst_clock() const;

  /// Returns true if any client has subscribed to the raw messages of this sensor's device.
  bool wants_trace(std::string_view sensor) const;
  /// Sends one to these clients. A client that reads too slowly misses some; the next one counts them.
  void publish_trace(const wire::RawTrace& trace);

  void close() override;

  /// Admits clients by other limits from now on. Those that are there stay.
  void set_admission(const AdmissionLimits& admission);

  const ClientCounts& counts() const;

 private:
  class Server;  // keeps Asio, which is slow to compile, in one file
  std::shared_ptr<Server> server_;
};

}  // namespace yuragi::daemon::stream
