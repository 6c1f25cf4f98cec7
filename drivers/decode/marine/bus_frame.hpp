#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "drivers/decode/marine/wind_data.hpp"

namespace yuragi::drivers::decode::marine {

// The common part of the text formats of NMEA 2000 frames. Nothing here allocates, throws or keeps state. Thread-safe
// and realtime-safe: yes.

/// One CAN frame.
struct BusFrame {
  std::uint32_t identifier = 0;  ///< 29 bits
  std::array<std::uint8_t, 8> data{};
  std::size_t size = 0;  ///< of the data
};

/// The content of an identifier. Source: drivers/SOURCES.md S11.
struct BusIdentifier {
  std::uint8_t priority = 0;  ///< 0: first; 7: last
  std::uint32_t pgn = 0;      ///< which message it is
  std::uint8_t address = 0;   ///< of the device that sends it
};
BusIdentifier bus_identifier_of(std::uint32_t identifier) noexcept;

/// The wind in a frame. Refusals, in this order: kNotMine (another PGN), then as decode_wind_data().
Result<BusWind, Refusal> decode_bus_frame(const BusFrame& frame) noexcept;

/// A hexadecimal number of exactly this many digits, at most 8.
std::optional<std::uint32_t> hex_number(std::string_view text, std::size_t digits) noexcept;

}  // namespace yuragi::drivers::decode::marine
