#pragma once

#include <string_view>

#include "drivers/decode/marine/wind_data.hpp"

namespace yuragi::drivers::decode::marine {

// The messages of an NMEA 2000 bus as canboat's actisense-serial and its other readers print them, a line each;
// canboatjs and Signal K servers write the same.
//
//   2018-02-14T15:55:07.944Z,2,130306,3,255,8,09,44,00,3b,a0,fa,ff,ff
//   2011-11-24-22:42:04.388,2,130306,36,255,8,7b,02,02,c5,2a,fa,ff,ff
//
// Time, priority, PGN, the sender's address, the destination, number of bytes, and the bytes in hexadecimal. A message
// of several frames (fast packet) may stand in one line of up to 223 bytes. There is no checksum. Sources:
// drivers/SOURCES.md S11.

/// Returns true if it begins with a date, as such a line does.
bool looks_like_canboat_plain(std::string_view line) noexcept;

/// Returns the time in such a line, as written; empty if the line has none.
std::string_view canboat_plain_time(std::string_view line) noexcept;

/// The wind in one line. Refusals, in this order: kTooShort (it ends before its data), kMalformed (not this format),
/// kNotMine (another PGN), kMalformed (more than 8 bytes), kTooShort or kMalformed (fewer or more bytes than it states,
/// or something else among them), then as decode_wind_data(). Thread-safe and realtime-safe: yes.
Result<BusWind, Refusal> decode_canboat_plain(std::string_view line) noexcept;

}  // namespace yuragi::drivers::decode::marine
