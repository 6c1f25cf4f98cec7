#include "engine/wire/message_reader.hpp"

namespace yuragi::wire {

MessageReader::MessageReader(std::size_t max_message_bytes) : max_message_bytes_(max_message_bytes) {}

void MessageReader::feed(std::span<const std::uint8_t> bytes) {
  // A whole message of the maximum length is already waiting: the caller does not take messages.
  if (buffered_bytes() >= kSizePrefixBytes + max_message_bytes_) broken_ = true;
  if (broken_) return;

  // Removes the gap of taken messages, so that the buffer is only as long as the waiting bytes.
  if (consumed_ > 0) {
    buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(consumed_));
    consumed_ = 0;
  }
  buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
}

std::optional<Result<Message, Error>> MessageReader::next() {
  if (broken_) return Error::kTooLong;
  const auto waiting = std::span<const std::uint8_t>(buffer_).subspan(consumed_);
  if (waiting.size() < kSizePrefixBytes) return std::nullopt;

  // The length is bounded before anything is done with it.
  const auto length = read_size_prefix(waiting.first<kSizePrefixBytes>(), max_message_bytes_);
  if (!length) {
    broken_ = true;
    buffer_.clear();
    consumed_ = 0;
    return length.error();
  }
  if (waiting.size() - kSizePrefixBytes < *length) return std::nullopt;

  consumed_ += kSizePrefixBytes + *length;
  return decode(waiting.subspan(kSizePrefixBytes, *length));
}

}  // namespace yuragi::wire
