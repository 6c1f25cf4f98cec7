#include "drivers/decode/lufft/umb_assembler.hpp"

#include <algorithm>
#include <utility>

namespace yuragi::drivers::decode::lufft {
namespace {

/// From the start of the frame to its length.
constexpr std::size_t kHeaderWithLength = 7;

bool has_right_end(ByteSpan frame) {
  const std::size_t size = frame.size();
  return frame[size - 4] == 0x03 && frame[size - 1] == 0x04 &&
         umb_checksum(frame.first(size - 3)) == little_endian_16(frame, size - 3);
}

}  // namespace

std::optional<UmbAssembler::Frame> UmbAssembler::next(ByteSpan& bytes) noexcept {
  drop_front(std::exchange(taken_, 0));
  while (true) {
    // A damaged length can have hidden a whole frame, so that the rest can already contain one.
    if (size_ >= kHeaderWithLength && size_ >= umb_frame_size(bytes_)) {
      const ByteSpan frame = ByteSpan(bytes_).first(umb_frame_size(bytes_));
      if (has_right_end(frame)) {
        is_outside_ = false;
        taken_ = frame.size();
        return frame;
      }
      drop_front(1);
      is_outside_ = true;  // bytes up to the next beginning belong to this one
      return Refusal::kBadChecksum;
    }
    if (bytes.empty()) return std::nullopt;
    bytes_[size_++] = bytes.front();
    bytes = bytes.subspan(1);
    if (!begins_umb_frame(ByteSpan(bytes_).first(size_))) {
      drop_front(1);
      if (!std::exchange(is_outside_, true)) return Refusal::kMalformed;
    }
  }
}

bool UmbAssembler::cut() noexcept {
  const bool was_begun = size_ > taken_;
  size_ = taken_ = 0;
  is_outside_ = false;
  return was_begun;
}

/// Drops `count` bytes, and those up to the next beginning of a frame, or all.
void UmbAssembler::drop_front(std::size_t count) noexcept {
  while (count < size_ && !begins_umb_frame(ByteSpan(bytes_).subspan(count, size_ - count))) ++count;
  std::copy(bytes_.begin() + static_cast<std::ptrdiff_t>(count), bytes_.begin() + static_cast<std::ptrdiff_t>(size_),
            bytes_.begin());
  size_ -= count;
}

}  // namespace yuragi::drivers::decode::lufft
