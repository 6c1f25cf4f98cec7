#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "drivers/decode/byte_order.hpp"
#include "drivers/decode/decoded_wind.hpp"
#include "drivers/decode/refusal.hpp"
#include "engine/base/result.hpp"
#include "engine/wind/station_quantities.hpp"

namespace yuragi::drivers::decode::network {

// The current values of a gateway by Fine Offset (Ecowitt GW1000, GW1100, GW1200, GW2000, and consoles that speak as
// they do), asked for over TCP. Source: Fine Offset, "Data exchange TCP Protocol for GW1000, 1100, 1900, 2000, 2680,
// 2650", v1.6.4; drivers/SOURCES.md S9.2.
//
//   request   ff ff 27 03 2a
//   reply     ff ff, 27, size (2 bytes: from the command to the checksum), items, checksum (of command, size and items)
//   item      an id and its value, whose length follows from the id alone; numbers begin with the high byte
//
//             02  temperature outside, 0.1 degrees Celsius, signed     0a  direction, degrees
//             07  humidity outside, %                                  0b  mean wind, 0.1 m/s
//             08  pressure at the gateway, 0.1 hPa                     0c  gust, 0.1 m/s
//             0e, 80  rate of rain, 0.1 mm/h: of a bucket, of a piezo sensor (WS90)
//             14; 13, 86  rain since ever; since the year began: bucket, piezo; 0.1 mm (4 bytes)
//
// Items of sensors that the gateway does not hear are left out.

/// The request for the current values.
inline constexpr std::array<std::uint8_t, 5> kEcowittRequest = {0xFF, 0xFF, 0x27, 0x03, 0x2A};

/// Longer than any reply: all items together have less than 400 bytes.
inline constexpr std::size_t kMaxEcowittReply = 1024;

/// The values in a reply.
struct EcowittValues {
  /// Without its time. Values are not checked for their range (wind::plausible_part).
  wind::StationQuantities quantities = {};
  /// kInvalid: it has no speed. kImplausible.
  Result<DecodedWind, Refusal> wind = Refusal::kInvalid;
};

/// Returns the size of the whole reply that begins so, in bytes; kTooShort (not known yet), kMalformed (no such reply),
/// kNotMine (the reply to another command). Thread-safe and realtime-safe: yes.
Result<std::size_t, Refusal> ecowitt_reply_size(ByteSpan beginning) noexcept;

/// A whole reply, or the first thing that is wrong with it: as ecowitt_reply_size(), kTooShort, kBadChecksum,
/// kMalformed (items that do not fit). Items after one of unknown id are not read. A gust below the mean wind is left
/// out. The checksum is a sum of 8 bits: it finds each change of one byte, and 255 of 256 changes in several places.
/// Thread-safe and realtime-safe: yes.
Result<EcowittValues, Refusal> decode_ecowitt(ByteSpan reply) noexcept;

}  // namespace yuragi::drivers::decode::network
