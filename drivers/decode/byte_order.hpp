#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace yuragi::drivers::decode {

// Numbers and sums of bytes. The caller has checked that the bytes are there. Thread-safe and realtime-safe: yes.

using ByteSpan = std::span<const std::uint8_t>;

constexpr std::uint16_t big_endian_16(ByteSpan bytes, std::size_t at) noexcept {
  return static_cast<std::uint16_t>((bytes[at] << 8U) | bytes[at + 1]);
}

constexpr std::uint16_t little_endian_16(ByteSpan bytes, std::size_t at) noexcept {
  return static_cast<std::uint16_t>(bytes[at] | (bytes[at + 1] << 8U));
}

constexpr std::uint32_t little_endian_32(ByteSpan bytes, std::size_t at) noexcept {
  return little_endian_16(bytes, at) | (static_cast<std::uint32_t>(little_endian_16(bytes, at + 2)) << 16U);
}

/// The arithmetic sum, modulo 2^16.
constexpr std::uint16_t sum_16(ByteSpan bytes) noexcept {
  std::uint32_t sum = 0;
  for (const std::uint8_t byte : bytes) sum += byte;
  return static_cast<std::uint16_t>(sum);
}

/// All bytes, exclusive or.
constexpr std::uint8_t xor_8(ByteSpan bytes) noexcept {
  unsigned all = 0;
  for (const std::uint8_t byte : bytes) all ^= byte;
  return static_cast<std::uint8_t>(all);
}

}  // namespace yuragi::drivers::decode
