#include "daemon/feeds/e131_packet.hpp"

#include <algorithm>

namespace yuragi::daemon::feeds {
namespace {

// Octets of the fields (table 4-1).
constexpr std::size_t kRootLength = 16, kComponent = 22, kFramingLength = 38, kSource = 44, kPriority = 108,
                      kSequence = 111, kOptions = 112, kUniverse = 113, kDmpLength = 115, kLevels = 126;
constexpr std::size_t kMaxSource = 63;  // and a zero
constexpr std::uint8_t kTerminated = 0x40;

using Bytes = std::array<std::uint8_t, kE131Size>;

void put_16(Bytes& bytes, std::size_t at, std::size_t value) {
  bytes[at] = static_cast<std::uint8_t>(value >> 8U);
  bytes[at + 1] = static_cast<std::uint8_t>(value);
}

/// Flags 0x7 and the length of what follows from here to the end.
void put_length(Bytes& bytes, std::size_t at) {
  put_16(bytes, at, 0x7000U | (kE131Size - at));
}

/// As much of a text as fits, without a part of a character.
std::string_view cut(std::string_view text) {
  if (text.size() <= kMaxSource) return text;
  std::size_t end = kMaxSource;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
  return text.substr(0, end);
}

}  // namespace

std::array<std::uint8_t, kE131Size> encode_e131(const E131Packet& packet, const DmxLevels& levels) noexcept {
  constexpr std::array<std::uint8_t, 16> kHead = {0x00, 0x10, 0x00, 0x00, 'A', 'S', 'C', '-',
                                                  'E',  '1',  '.',  '1',  '7', 0,   0,   0};
  Bytes bytes{};
  std::ranges::copy(kHead, bytes.begin());
  put_length(bytes, kRootLength);
  bytes[kRootLength + 5] = 0x04;  // VECTOR_ROOT_E131_DATA
  std::ranges::copy(packet.component, bytes.begin() + kComponent);
  put_length(bytes, kFramingLength);
  bytes[kFramingLength + 5] = 0x02;  // VECTOR_E131_DATA_PACKET
  std::ranges::copy(cut(packet.source), bytes.begin() + kSource);
  bytes[kPriority] = packet.priority;
  bytes[kSequence] = packet.sequence;
  bytes[kOptions] = packet.is_terminated ? kTerminated : 0;
  put_16(bytes, kUniverse, packet.universe);
  put_length(bytes, kDmpLength);
  bytes[kDmpLength + 2] = 0x02;                      // VECTOR_DMP_SET_PROPERTY
  bytes[kDmpLength + 3] = 0xA1;                      // type of addresses and data
  put_16(bytes, kDmpLength + 6, 1);                  // address increment; the first address is 0
  put_16(bytes, kDmpLength + 8, 1 + levels.size());  // with the start code, 0
  std::ranges::copy(levels, bytes.begin() + kLevels);
  return bytes;
}

}  // namespace yuragi::daemon::feeds
