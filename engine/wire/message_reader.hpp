#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "engine/base/result.hpp"
#include "engine/wire/wire.hpp"

namespace yuragi::wire {

/// Cuts a byte stream, as it comes from a socket or a file, into messages. Pure: it knows no socket.
///
///     reader.feed(received);
///     while (auto message = reader.next()) { if (!*message) ...; else use(**message); }
///
/// A size prefix above the limit ends the stream: the begin of the next message is then unknown, so next() returns
/// kTooLong from then on. Any other bad message is reported once and skipped.
///
/// Memory: the received part of one message, at most the limit, plus one feed. A prefix alone reserves no memory, and a
/// caller who continues to feed without calling next() gets kTooLong. Thread-safe: no. Realtime-safe: no; decoding
/// allocates.
class MessageReader {
 public:
  /// `max_message_bytes` bounds one message, without its size prefix.
  explicit MessageReader(std::size_t max_message_bytes = kMaxServerMessageBytes);

  /// Takes the next bytes of the stream, any number of them. They are copied.
  void feed(std::span<const std::uint8_t> bytes);

  /// The next whole message, or the error in it; nullopt if more bytes are needed.
  std::optional<Result<Message, Error>> next();

  /// Bytes that wait for the rest of their message.
  std::size_t buffered_bytes() const noexcept { return buffer_.size() - consumed_; }

 private:
  std::size_t max_message_bytes_;
  Bytes buffer_;
  std::size_t consumed_ = 0;  ///< bytes at the front of buffer_ that next() has dealt with
  bool broken_ = false;
};

}  // namespace yuragi::wire
