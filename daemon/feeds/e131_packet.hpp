#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "daemon/feeds/component_id.hpp"
#include "daemon/settings/feeds/dmx.hpp"

namespace yuragi::daemon::feeds {

using DmxLevels = std::array<std::uint8_t, settings::feeds::kDmxChannels>;

/// An E1.31 data packet with all channels of a universe.
struct E131Packet {
  ComponentId component{};
  std::string_view source;  ///< UTF-8; longer than 63 bytes it is cut
  std::uint8_t priority = 100;
  std::uint8_t sequence = 0;
  bool is_terminated = false;  ///< the source sends no more of this universe
  std::uint16_t universe = 1;
};
inline constexpr std::size_t kE131Size = 126 + settings::feeds::kDmxChannels;

/// Its bytes, by ANSI E1.31-2018, tables 4-1 (data packet), 5-4, 6-6 and 7-8. Pure.
std::array<std::uint8_t, kE131Size> encode_e131(const E131Packet& packet, const DmxLevels& levels) noexcept;

}  // namespace yuragi::daemon::feeds
