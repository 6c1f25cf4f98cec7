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

  /// Takes bytes from the front of `bytes` until a frame is whole or they are used up: then nothing. The view is valid
  /// until the next call; its layout and its checksum are right. Refusals: kBadChecksum (or not the end of a frame),
  /// kMalformed (bytes that belong to none; told once for all that come together).
  std::optional<Frame> next(ByteSpan& bytes) noexcept;

  /// What has come of a frame will not be continued. Returns whether there was any.
  bool cut() noexcept;

 private:
  void drop_front(std::size_t count) noexcept;

  std::array<std::uint8_t, kMaxUmbFrame> bytes_{};
  std::size_t size_ = 0;
  std::size_t taken_ = 0;    // of bytes_: the frame of the last call
  bool is_outside_ = false;  // the bytes before belonged to no frame, and it has been told
};

}  // namespace yuragi::drivers::decode::lufft
