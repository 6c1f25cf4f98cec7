#pragma once

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "engine/base/result.hpp"
#include "engine/base/time.hpp"
#include "engine/wire/wire.hpp"

namespace yuragi::daemon::stream {

/// Why there is no message.
enum class End : std::uint8_t {
  kTimeout,  ///< none in time; the connection is still open
  kClosed,   ///< the server closed the connection, or it failed
  kInvalid,  ///< the server sent an invalid message; the connection is closed
};
std::string_view name_of(End end);

/// Returns the failure if `message` is a Hello by which the daemon at `address` refuses the connection or shows that it
/// speaks another protocol version; nullopt for any other message.
std::optional<Failure> refusal_in(const wire::Message& message, std::string_view address);

/// The failure for a connection to the daemon at `address` that ended.
Failure connection_lost(std::string_view address, End end);

[[noreturn]] inline void throw_exception_from_error(End end, const boost::source_location&) {
  throw std::runtime_error("stream: " + std::string(name_of(end)));
}

/// A blocking client of the stream, for commands and tests.
///
///     auto client = Client::connect("127.0.0.1:7410", std::chrono::seconds(2));
///     if (client && client->subscribe({.sensors = true})) while (auto message = client->receive(...)) ...
///
/// Thread-safe: no.
class Client {
 public:
  /// Connects to `address` ("HOST:PORT") within `timeout`. Looking up a host name comes first and may take longer.
  static Result<Client, Failure> connect(std::string_view address, Nanoseconds timeout);

  Client(Client&&) noexcept;
  Client& operator=(Client&&) noexcept;
  ~Client();

  /// Subscribes; once. False if the connection is closed.
  bool subscribe(const wire::Subscribe& request);

  /// Sends a request, after subscribe(). False if the connection is closed.
  bool send(const wire::Control& request);

  /// Waits at most `timeout` for the next message. Messages of unknown kinds are skipped.
  Result<wire::Message, End> receive(Nanoseconds timeout);

 private:
  class Connection;
  explicit Client(std::unique_ptr<Connection> connection);
  std::unique_ptr<Connection> connection_;
};

}  // namespace yuragi::daemon::stream
