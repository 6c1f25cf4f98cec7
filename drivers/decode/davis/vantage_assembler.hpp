#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "drivers/decode/byte_order.hpp"
#include "drivers/decode/davis/vantage.hpp"
#include "drivers/decode/refusal.hpp"
#include "engine/base/result.hpp"

namespace yuragi::drivers::decode::davis {

/// Makes packets of bytes, however these were split on their way: finds where one begins, and after a damaged one looks
/// for the next beginning within it, so that a byte that was lost or added costs one packet only.
///
///     while (const auto packet = assembler.next(bytes)) use(*packet);
///
/// Not thread-safe; realtime-safe: no allocation.
class VantageAssembler {
 public:
  using Packet = Result<ByteSpan, Refusal>;

  /// Takes bytes from the front of `bytes` until a packet is complete, or they are used up: then it returns nullopt.
  /// The view is valid until the next call; its checksum is right. Refusals: kBadChecksum (or not the end of a packet),
  /// kMalformed (bytes that belong to none; returned once for adjacent ones).
  std::optional<Packet> next(ByteSpan& bytes) noexcept;

  /// Discards an incomplete packet. Returns whether there was one.
  bool cut() noexcept;

 private:
  void drop_front() noexcept;

  std::array<std::uint8_t, kVantagePacket> bytes_{};
  std::size_t size_ = 0;
  bool is_taken_ = false;    // bytes_ is the packet of the last call
  bool is_outside_ = false;  // the bytes before belonged to no packet, and were refused
};

}  // namespace yuragi::drivers::decode::davis
