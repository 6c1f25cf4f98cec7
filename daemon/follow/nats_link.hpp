#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace yuragi::daemon::follow {

/// A message of NATS, sent or received.
struct NatsMessage {
  std::string subject;
  std::string reply_to;  ///< where a reply is expected; empty: nowhere
  std::vector<std::uint8_t> bytes;
};

/// How a NatsLink connects, and its limits.
struct NatsSettings {
  /// "nats://host:4222", or "tls://host:4222" for TLS; tried in this order, then again, for ever.
  std::vector<std::string> servers;
  std::string name;  ///< shown by the server's monitoring
  /// A file with `user:password` in one line, or with the seed of an nkey ("SU..."); empty: no credentials. It is read
  /// again before each connection, and refused if everybody can read it.
  std::filesystem::path credentials;
  std::filesystem::path authorities;  ///< certificates that are trusted (PEM), for TLS; empty: the system's
  std::size_t max_message_bytes = std::size_t{256} * 1024;  ///< longer messages are dropped and counted, both ways
  std::size_t max_waiting = 4096;  ///< messages that may wait, each way; others are dropped and counted
};

/// A connection to one of several NATS servers, on a thread of its own, which connects again for ever. No function
/// waits for the network. A lost connection is replaced by the next server at once; when all servers have failed in
/// turn, it waits 0.25 s, later up to 5 s. A server that hangs is not noticed here: its user, who knows how often
/// messages have to come, calls leave_server(). A machine that vanished is noticed after 10 s. A trouble is logged
/// once, and once that it is over.
///
/// libnats sends and receives TLS by busy waiting while a record is incomplete: a TLS connection that is stuck costs a
/// processor until leave_server() or the destructor ends it.
///
/// Thread-safe: yes, except the destructor.
class NatsLink {
 public:
  struct State {
    bool is_connected = false;
    std::string server;      ///< the one that is connected or tried, without user and password
    std::string trouble;     ///< what is wrong and what to do; while connected: what the server did not permit
    std::uint64_t sent = 0;  ///< messages handed to a connection
    std::uint64_t sent_bytes = 0;
    std::uint64_t received = 0;  ///< messages that were queued for received()
    std::uint64_t received_bytes = 0;
    std::uint64_t lost = 0;         ///< dropped messages, both ways: too long, too many, or not connected
    std::uint64_t connections = 0;  ///< that succeeded
  };

  /// `subjects`: what is subscribed to, besides inbox(). `on_arrival`: called on another thread after messages were
  /// queued; it must be short, may throw, and must not destroy the link. It is not called after the destructor, and
  /// destroyed when the link's last thread ends.
  NatsLink(NatsSettings settings, std::vector<std::string> subjects, std::function<void()> on_arrival);

  /// Sends what the server takes at once, and waits 0.25 s at most: a thread that hangs is left behind.
  ~NatsLink();
  NatsLink(const NatsLink&) = delete;
  NatsLink& operator=(const NatsLink&) = delete;

  /// Returns why this build cannot connect to NATS; nullopt if it can.
  static std::optional<std::string> refusal();

  /// Queues a copy of `bytes`. The message is dropped and counted if it is too long, if a subject is not valid, if too
  /// many messages wait, or if there is no connection.
  void publish(std::string_view subject, std::span<const std::uint8_t> bytes, const std::string& reply_to = {});

  /// A subject of this link alone ("_INBOX.<random>"), for replies. It is subscribed to.
  const std::string& inbox() const;

  /// Returns the messages that came since the last call. Those of one subscription are in the server's order; messages
  /// of two subscriptions that came within the same 32 kB may be exchanged.
  std::vector<NatsMessage> received();

  /// Gives up the present connection and goes to the next server at once, without waiting for what was not yet sent.
  /// Does nothing while there is no connection.
  void leave_server();

  State state() const;

 private:
  struct Shared;
  class Worker;
  std::shared_ptr<Shared> shared_;
};

}  // namespace yuragi::daemon::follow
