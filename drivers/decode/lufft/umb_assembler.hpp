#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "drivers/decode/byte_order.hpp"
#include "drivers/decode/lufft/umb.hpp"
#include "drivers/decode/refusal.hpp"
#include "engine/base/result.hpp"

namespace yuragi::drivers::decode::lufft {

/// Makes frames of bytes, however these were split on their way: finds where one begins, and after a damaged one looks
/// for the next beginning within it, so that a byte that was lost or added costs one frame only.
///
///     while (const auto frame = assembler.next(bytes)) use(*frame);
///
/// Not thread-safe; realtime-safe: no allocation.
class UmbAssembler {
 public:
  using Frame = Result<ByteSpan, Refusal>;

  /// Takes bytes from the front of `bytes` until a frame is complete, or they are used up: then it returns nullopt. The
  /// view is valid until the next call; its layout and its checksum are right. Refusals: kBadChecksum (or not the end
  /// of a frame), kMalformed (bytes that belong to none; returned once for adjacent ones).
  std::optional<Frame> next(ByteSpan& bytes) noexcept;

  /// Discards an incomplete frame. Returns whether there was one.
  bool cut() noexcept;

 private:
  void drop_front(std::size_t count) noexcept;

  std::array<std::uint8_t, kMaxUmbFrame> bytes_{};
  std::size_t size_ = 0;
  std::size_t taken_ = 0;    // of bytes_: the frame of the last call
  bool is_outside_ = false;  // the bytes before belonged to no frame, and were refused
};

}  // namespace yuragi::drivers::decode::lufft
