#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "drivers/bus/byte_port.hpp"
#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi::drivers::davis {

/// One request after another to a server of HTTP/1.1, each over a connection of its own, and its reply piece by piece,
/// so that the caller can do other work meanwhile, and can be interrupted. Replies of more than 64 KiB are refused.
///
/// Thread-safe: interrupt() alone; everything else belongs to one thread.
class HttpExchange {
 public:
  /// `host`: for the request's header.
  HttpExchange(std::string host, std::unique_ptr<bus::BytePort> port);
  ~HttpExchange();

  /// Abandons a pending request, connects, and sends "GET `target`". Blocks as the port's open() does.
  Result<void, Failure> begin(const std::string& target);
  bool is_under_way() const noexcept { return parser_ != nullptr; }

  /// Waits for that time for more of the reply. Returns its body once it is complete, nullopt while more is to come. A
  /// failure is one of the connection, of the protocol, or a status that is not 200.
  std::optional<Result<std::string, Failure>> advance(Nanoseconds timeout);

  /// Gives the request up, and closes the connection.
  void end() noexcept;

  void interrupt() noexcept { port_->interrupt(); }

 private:
  struct Parser;

  std::string host_;
  std::unique_ptr<bus::BytePort> port_;
  std::unique_ptr<Parser> parser_;
  std::array<std::uint8_t, 4096> buffer_{};
};

}  // namespace yuragi::drivers::davis
