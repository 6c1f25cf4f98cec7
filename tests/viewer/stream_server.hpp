#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>

#include "engine/wire/wire.hpp"

namespace yuragi::viewer {

/// A server on loopback that says what a test tells it to say. It reads each client's Subscribe, Controls and Displays.
/// Thread-safe: yes. Sending never waits; what a slow client does not read is kept.
class StreamServer {
 public:
  /// `port` 0 takes any free one. `greeting` is what each client hears at once: bytes, whatever they are.
  explicit StreamServer(wire::Bytes greeting, std::uint16_t port = 0);
  ~StreamServer();
  StreamServer(const StreamServer&) = delete;
  StreamServer& operator=(const StreamServer&) = delete;

  std::uint16_t port() const { return port_; }

  /// To every client that has subscribed.
  void send(wire::Bytes bytes);

  /// Closes every connection; goes on listening.
  void cut();

  /// Waits (up to half a minute) until as many subscriptions as this have come in all.
  bool wait_for_subscriptions(std::size_t count);

  /// The token of the last subscription.
  Secret token() {
    const std::lock_guard lock(mutex_);
    return token_;
  }

  /// Of the last Display; null where none has come.
  std::optional<std::uint8_t> given_up() {
    const std::lock_guard lock(mutex_);
    return given_up_;
  }

  /// Waits (up to half a minute) until as many Controls as this have come in all, and returns them.
  std::vector<wire::Control> wait_for_controls(std::size_t count);

 private:
  struct Client;
  void accept();
  void read_subscription(const std::shared_ptr<Client>& client);
  void write_next(const std::shared_ptr<Client>& client);

  wire::Bytes greeting_;
  boost::asio::io_context context_{1};
  boost::asio::ip::tcp::acceptor acceptor_;
  std::uint16_t port_ = 0;
  std::list<std::shared_ptr<Client>> clients_;

  std::mutex mutex_;
  std::condition_variable subscribed_;
  std::size_t subscriptions_ = 0;
  std::vector<wire::Control> controls_;
  std::optional<std::uint8_t> given_up_;
  Secret token_;

  std::thread thread_;
};

/// One message after another.
wire::Bytes operator+(wire::Bytes a, const wire::Bytes& b);

}  // namespace yuragi::viewer
