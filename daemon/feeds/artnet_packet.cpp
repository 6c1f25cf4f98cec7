#include "daemon/feeds/artnet_packet.hpp"

#include <algorithm>

namespace yuragi::daemon::feeds {

std::array<std::uint8_t, kArtDmxSize> encode_artdmx(std::uint16_t address, std::uint8_t sequence,
                                                    const DmxLevels& levels) noexcept {
  constexpr std::uint8_t kProtocolVersion = 14;
  const std::array<std::uint8_t, 18> head = {'A',
                                             'r',
                                             't',
                                             '-',
                                             'N',
                                             'e',
                                             't',
                                             0,
                                             0x00,
                                             0x50,  // OpDmx, the low byte first
                                             0x00,
                                             kProtocolVersion,
                                             sequence,
                                             0x00,  // the physical input port, for information
                                             static_cast<std::uint8_t>(address),
                                             static_cast<std::uint8_t>(address >> 8U),
                                             static_cast<std::uint8_t>(levels.size() >> 8U),
                                             static_cast<std::uint8_t>(levels.size())};
  std::array<std::uint8_t, kArtDmxSize> bytes{};
  std::ranges::copy(head, bytes.begin());
  std::ranges::copy(levels, bytes.begin() + head.size());
  return bytes;
}

}  // namespace yuragi::daemon::feeds
