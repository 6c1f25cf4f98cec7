#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "daemon/feeds/e131_packet.hpp"

namespace yuragi::daemon::feeds {

inline constexpr std::size_t kArtDmxSize = 18 + settings::feeds::kDmxChannels;

/// The bytes of an ArtDmx packet with all channels of a universe (Art-Net 4 Protocol Release V1.4, "ArtDmx").
/// `address`: the port-address, of 15 bits: net, subnet and universe. `sequence`: 1 to 255; 0: packets are taken in any
/// order. Pure.
std::array<std::uint8_t, kArtDmxSize> encode_artdmx(std::uint16_t address, std::uint8_t sequence,
                                                    const DmxLevels& levels) noexcept;

}  // namespace yuragi::daemon::feeds
