#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "drivers/decode/byte_order.hpp"
#include "drivers/decode/decoded_wind.hpp"
#include "drivers/decode/refusal.hpp"
#include "engine/base/result.hpp"
#include "engine/wind/station_quantities.hpp"

namespace yuragi::drivers::decode::hid {

// Hideki TE923 (Meade, TFA Nexus, Mebus, IROX; USB 1130:6801).
// Source: weewx drivers/te923.py, whose indices count from behind the header byte: ours count from the block's first
// byte, and are one more; drivers/SOURCES.md S2.5.
//
// A block is requested by an output report of 8 bytes, comes in input reports of 8 bytes (how many of the next 7 are
// valid, then those), and is acknowledged.
//
//   request   05 af, address low, middle, high, exclusive or of af and these three, 00 00  (acknowledgement: 24 for 05)
//   block     0         0x5A
//   (34)      33        exclusive or of bytes 0 to 32
//   at        26, 27    gust           28, 29   speed          both mph, as below
//   0x020001  30        low nibble: direction, points of 22.5 degrees
//   speed     first     two decimal digits: ones and tenths
//             second    low nibble: tens; bit 4: hundred. ee 8e, ff ff: no sensor
//   at        4, 5      temperature of channel 1, which is outdoors by weewx's map: two decimal digits, ones and tenths
//   0x020001            of degrees Celsius; then low nibble: tens; bit 5: 0.05 more; bit 6: it is valid; bit 7: not
//   below besides             zero. A digit above 9: no sensor
//             6         humidity of channel 1, two decimal digits, %; a digit above 9: no sensor
//             21, 22    pressure reduced to sea level, 1/16 hPa, low byte first; a high nibble f: none
//             31, 32    tips of the rain gauge since the count was 0, low byte first. A tip is 1/36 inch by weewx,
//             which
//                       compared it with the console's display, and 0.6578 mm by the maker

inline constexpr std::size_t kTe923Block = 34;
inline constexpr std::uint32_t kTe923Readings = 0x020001;  ///< the address of the current readings

std::array<std::uint8_t, 8> encode_te923_request(std::uint32_t address) noexcept;
std::array<std::uint8_t, 8> encode_te923_acknowledgement(std::uint32_t address) noexcept;

/// The wind of the block at kTe923Readings, or the first thing that is wrong: kTooShort, kMalformed (another header,
/// too long), kBadChecksum, kInvalid (no sensor, or digits that are none). Without a speed there is no direction
/// either: the block keeps an old one. Thread-safe and realtime-safe: yes.
Result<DecodedWind, Refusal> decode_te923(ByteSpan block) noexcept;

/// Returns the other quantities in such a block, without its time; nullopt if decode_te923() would refuse it, except as
/// kInvalid. The console counts the rain itself: the block does not show whether it still receives the gauge. Values
/// are not checked for their range (wind::plausible_part). Thread-safe and realtime-safe: yes.
std::optional<wind::StationQuantities> decode_te923_quantities(ByteSpan block) noexcept;

}  // namespace yuragi::drivers::decode::hid
