#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "drivers/decode/byte_order.hpp"
#include "drivers/decode/decoded_wind.hpp"
#include "drivers/decode/refusal.hpp"
#include "engine/base/result.hpp"
#include "engine/wind/station_quantities.hpp"

namespace yuragi::drivers::decode::davis {

// Consoles of Davis Vantage Pro, Vantage Pro2 and Vantage Vue: the packets LOOP and LOOP2.
// Source: Davis, "Vantage Pro, Vantage Pro2 and Vantage Vue Serial Communication Reference Manual" 2.6.1; weewx
// drivers/vantage.py (marks for "no value"); drivers/SOURCES.md S10.1.
//
//   0, 1, 2   "LOO"                       3   trend of the pressure, or "P" (firmware before April 2002)
//   4         0: LOOP, 1: LOOP2
//   7, 8      pressure at sea level, 0.001 inHg; 0: none
//   12, 13    temperature outside, 0.1 degrees Fahrenheit, signed; 0x7fff: none
//   14        speed, mph; 0xff: none, but see below
//   16, 17    direction, 1 to 360 degrees; 0, 0x7fff: none
//   18, 19    LOOP2: average of 10 minutes, 0.1 mph; 0x7fff, 0xffff: none
//   22, 23    LOOP2: strongest gust of 10 minutes, mph; 0xff, 0x7fff, 0xffff: none
//   33        humidity outside, %; 0xff: none
//   41, 42    rain rate, tips an hour; 0xffff: none
//   50, 51    rain since midnight, tips; 0xffff: none
//   95, 96    LF CR
//   97, 98    checksum of all before it, high byte first
//
// All other numbers have their low byte first. According to the manual the gust is in 0.1 mph; recorded packets, and
// weewx issue 686, show whole mph.
//
// According to the manual, a console that has lost its anemometer sends a speed of 0. In a true calm it also sends the
// direction of the vane, for a lost anemometer none: a speed of 0 without a direction is no wind.

inline constexpr std::size_t kVantagePacket = 99;

/// CRC-CCITT: polynomial 0x1021, from 0 on, highest bit first. Over bytes that end with their own checksum it is 0.
/// Thread-safe and realtime-safe: yes.
std::uint16_t vantage_checksum(ByteSpan bytes) noexcept;

/// Returns true if these first bytes can be the beginning of such a packet. Thread-safe and realtime-safe: yes.
bool begins_vantage_packet(ByteSpan beginning) noexcept;

/// The wind of one packet, from north; or the first thing that is wrong with it: kTooShort, kMalformed (longer, another
/// packet, or another end), kBadChecksum, kInvalid (no speed, or the anemometer is lost). An impossible direction is
/// left out, and the reading uncertain; a gust that is impossible, or below the average of the same time, is left out.
/// Thread-safe and realtime-safe: yes.
Result<DecodedWind, Refusal> decode_vantage_packet(ByteSpan packet) noexcept;

/// Returns the other quantities in such a packet, without its time; nullopt if decode_vantage_packet() would refuse it
/// as kTooShort, kMalformed or kBadChecksum. `rain_of_a_tip_mm`: of the station's rain collector; empty: rain is left
/// out. The rain total is that since midnight. Values are not checked for their range (wind::plausible_part).
/// Thread-safe and realtime-safe: yes.
std::optional<wind::StationQuantities> decode_vantage_quantities(ByteSpan packet,
                                                                 std::optional<double> rain_of_a_tip_mm) noexcept;

/// Returns the rain collector's tip in mm, from the console's setup bits (its EEPROM at 0x2b); `reply` is that byte and
/// its checksum. kTooShort, kMalformed (longer), kBadChecksum, kInvalid (a collector that is not known). Thread-safe
/// and realtime-safe: yes.
Result<double, Refusal> decode_vantage_rain_of_a_tip_mm(ByteSpan reply) noexcept;

}  // namespace yuragi::drivers::decode::davis
