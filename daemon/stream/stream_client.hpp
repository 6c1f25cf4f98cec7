#pragma once

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "engine/base/result.hpp"
#include "engine/base/time.hpp"
#include "engine/wire/wire.hpp"

namespace yuragi {

/// Why there is no message.
enum class StreamEnd : std::uint8_t {
  kTimeout,  ///< none came in time; the connection is well, and one may come yet
  kClosed,   ///< the server closed the connection, or it broke
  kInvalid,  ///< the server sent what is no message; the connection is closed
};
std::string_view name_of(StreamEnd end);

/// Why the daemon at `address` does not serve this client, where `message` is a greeting that says so: it refuses the
/// connection, or speaks another protocol. Nothing for any other message.
std::optional<Failure> refusal_in(const wire::Message& message, std::string_view address);

/// What a person is told of the end of a connection to the daemon at `address`.
Failure connection_lost(std::string_view address, StreamEnd end);

[[noreturn]] inline void throw_exception_from_error(StreamEnd end, const boost::source_location&) {
  throw std::runtime_error("stream: " + std::string(name_of(end)));
}

/// A blocking client of the stream, for commands and tests.
///
///     auto client = StreamClient::connect("127.0.0.1:7410", std::chrono::seconds(2));
///     if (client && client->subscribe({.sensors = true})) while (auto message = client->receive(...)) ...
///
/// Thread-safe: no.
class StreamClient {
 public:
  /// Connects to `address` ("HOST:PORT") within `timeout`, or says why not. A name is looked up first, in the system's
  /// time.
  static Result<StreamClient, Failure> connect(std::string_view address, Nanoseconds timeout);

  StreamClient(StreamClient&&) noexcept;
  StreamClient& operator=(StreamClient&&) noexcept;
  ~StreamClient();

  /// Says what is wanted, once. False where the connection is closed.
  bool subscribe(const wire::Subscribe& request);

  /// Asks to show or hide a scene, after subscribe(). False where the connection is closed.
  bool send(const wire::Control& request);

  /// The next message, which is waited for no longer than `timeout`. Messages of kinds unknown here are passed over.
  Result<wire::Message, StreamEnd> receive(Nanoseconds timeout);

 private:
  class Connection;
  explicit StreamClient(std::unique_ptr<Connection> connection);
  std::unique_ptr<Connection> connection_;
};

}  // namespace yuragi
