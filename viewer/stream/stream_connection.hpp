#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/secret.hpp"
#include "engine/base/time.hpp"
#include "engine/wire/wire.hpp"

namespace yuragi::viewer::stream {

struct TimedFrame {
  wire::Frame frame;
  MonoTime arrival;
};

/// What was received since the last take(): scenes, then the frames of these scenes.
struct Inbox {
  bool is_of_new_connection = false;    ///< there will be no replies to messages sent over another one
  std::optional<double> wind_from_deg;  ///< from a new connection's Hello, if it contains it
  std::optional<wire::Scenes> scenes;   ///< the newest
  std::vector<TimedFrame> frames;       ///< oldest first
  std::optional<wire::Sensors> sensors;
  std::vector<wire::ControlReply> replies;  ///< oldest first
};

enum class State : std::uint8_t { kConnecting, kConnected, kWaiting };

struct Status {
  State state = State::kConnecting;
  std::string text;              ///< for a person: "connected to 127.0.0.1:7410 (yuragi 0.1.0)"
  bool is_same_machine = false;  ///< connected by an address of this machine: the daemon, or the end of a tunnel
};

struct Options {
  std::string host = "127.0.0.1";
  std::uint16_t port = wire::kDefaultPort;
  Secret token = {};                                         ///< of the daemon's installation; empty: none is sent
  Nanoseconds min_backoff = std::chrono::milliseconds(200);  ///< before the first new attempt; doubles
  Nanoseconds max_backoff = std::chrono::seconds(3);
  Nanoseconds silence_limit = std::chrono::seconds(6);  ///< connects again after this long without a byte, or a reply
};

/// A subscription to a daemon's stream, on a thread of its own, that is renewed without limit: if the daemon does not
/// reply, ends or sends invalid bytes, it closes the connection, waits, and connects again.
///
/// Memory is bounded: without take() the oldest frames and replies are dropped, never scenes. Thread-safe: yes; meant
/// for one reader. The destructor stops at once.
class Connection {
 public:
  static constexpr std::size_t kMaxWaitingFrames = 64;
  static constexpr std::size_t kMaxWaitingReplies = 64;

  explicit Connection(Options options);
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Returns what was received since the last call. Never waits for the network.
  Inbox take();

  Status status() const;

  /// Sends a Control, soon. Without a connection it is dropped, and there is no reply.
  void send(const wire::Control& control);
  /// The same; not sent to a daemon that does not know the message.
  void send(const wire::Display& display);

  /// Waits until there is something to take(), the status changes, or `limit` has passed.
  void wait_for_news(Nanoseconds limit);

 private:
  class Session;
  std::unique_ptr<Session> session_;
};

}  // namespace yuragi::viewer::stream
