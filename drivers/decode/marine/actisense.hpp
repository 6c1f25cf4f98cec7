#pragma once

#include <string_view>

#include "drivers/decode/marine/wind_data.hpp"

namespace yuragi::drivers::decode::marine {

// N2K ASCII of Actisense's gateways (W2K-1, W2K-2, PRO-NDC-1E2K): a line for each message, one of several frames (fast
// packet) as a whole.
//
//   A173321.107 23FF7 1F513 012F3070002F30709F
//
// A and the time (hhmmss.ddd); the sender's address, the destination and the priority; the PGN and the bytes, all in
// hexadecimal. There is no checksum. Sources: drivers/SOURCES.md S11.

/// Returns true if it begins with an A and a time, as such a line does.
bool looks_like_actisense(std::string_view line) noexcept;

/// Returns the time in such a line, as written but for the A; empty if the line has none.
std::string_view actisense_time(std::string_view line) noexcept;

/// The wind in one line. Refusals, in this order: kTooShort (it ends before its data), kMalformed (not this format),
/// kNotMine (another PGN), kMalformed (something else among the bytes, or more than 8), then as decode_wind_data().
/// Thread-safe and realtime-safe: yes.
Result<BusWind, Refusal> decode_actisense(std::string_view line) noexcept;

}  // namespace yuragi::drivers::decode::marine
