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

// Oregon Scientific WMR300 (USB 0fde:ca08).
// Source: weewx drivers/wmr300.py; drivers/SOURCES.md S2.2.
//
// Every packet is one input report. The console replies to a heartbeat with its identification (0x57 "WMR300,A002," and
// two bytes, at 12 and 13, which go back to it in the packet 73 e5 0a 26 that begins the sending of data). It sends for
// about 100 s by itself, and goes on while it gets a heartbeat every 20 s and an acknowledgement of every packet 0xD1
// to 0xDC. Wind, every 2.5 to 3 s, is packet 0xD4 (54 bytes, numbers big-endian, 0x7Fxx: no data):
//
//   0        0xD4
//   1        54, the packet's length
//   2 to 6   year, month, day, hour, minute
//   7        channel
//   8, 9     gust, 0.1 m/s           10, 11   the gust's direction, degrees
//   12, 13   average, 0.1 m/s        14, 15   the average's direction, degrees
//   18, 19   wind chill              20 ...   the records of the day
//   52, 53   sum of bytes 0 to 51, high byte first (of 0xD2, the history, low byte first)
//
// The others begin and end alike; what is read of them:
//
//   0xD3     (61 bytes, every 10 to 12 s) 7 channel: 0 the console's own, 1 outdoors (weewx's map), 2 to 8 further
//   ones;
//            8, 9 temperature, 0.1 degrees Celsius, two's complement; 10 humidity, %, 0x7F: no data
//   0xD5     (40 bytes, every 20 to 24 s) 15, 16 rain since it was reset, 0.01 inch; 17, 18 rate, 0.01 inch an hour
//   0xD6     (46 bytes, every 15 min) 8, 9 pressure at the station, 0.1 hPa; 10, 11 reduced to sea level

inline constexpr std::size_t kWmr300WindPacket = 54;

/// The heartbeat that keeps the console sending.
inline constexpr std::array<std::uint8_t, 5> kWmr300Heartbeat = {0xA6, 0x91, 0xCA, 0x45, 0x52};

/// The wind of a packet, or the first thing that is wrong: kTooShort, kNotMine (another packet), kMalformed (a length
/// that 0xD4 does not have), kBadChecksum, kInvalid (no data), kImplausible. Bytes behind the packet are the report's
/// padding. No state is kept between packets. Thread-safe and realtime-safe: yes.
Result<DecodedWind, Refusal> decode_wmr300(ByteSpan packet) noexcept;

/// Returns the other quantities in a packet, without its time: temperature and humidity outdoors, pressure at the
/// station, or rain; nullopt if it is damaged, has a wrong length for its kind, or is another sensor's. The bytes
/// behind it are the report's padding. Values are not checked for their range (wind::plausible_part). Thread-safe and
/// realtime-safe: yes.
std::optional<wind::StationQuantities> decode_wmr300_quantities(ByteSpan packet) noexcept;

/// Returns true for the console's reply to a heartbeat. If it does not send data yet, it needs encode_wmr300_begin() to
/// start.
bool is_wmr300_identity(ByteSpan packet) noexcept;

/// The packet that makes the console that replied with `identity` send data; is_wmr300_identity() holds for it.
std::array<std::uint8_t, 6> encode_wmr300_begin(ByteSpan identity) noexcept;

/// Returns true if the packet, of any kind, is complete and undamaged. Data packets end with a sum; of others only the
/// head is checked. Thread-safe and realtime-safe: yes.
bool is_sound_wmr300(ByteSpan packet) noexcept;

/// Returns true if this packet must be acknowledged: any data packet, also one that decode_wmr300() refuses as
/// kNotMine.
bool wants_wmr300_acknowledgement(ByteSpan packet) noexcept;

/// The acknowledgement of `packet`, for which wants_wmr300_acknowledgement() holds.
std::array<std::uint8_t, 6> encode_wmr300_acknowledgement(ByteSpan packet) noexcept;

}  // namespace yuragi::drivers::decode::hid
