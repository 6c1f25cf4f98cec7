#pragma once

#include <string_view>

#include "drivers/decode/marine/wind_data.hpp"

namespace yuragi::drivers::decode::marine {

// The RAW mode of Yacht Devices' gateways (YDWG-02, YDEN-02, YDNU-02): a line for each frame on the bus.
//
//   17:33:21.179 R 09FD0205 64 1E 01 C8 F1 FA FF FF
//
// Time; R: received from the bus, T: sent to it by a program; the CAN identifier (29 bits: priority, PGN, the sender's
// address) and the data bytes in hexadecimal. There is no checksum. Source: YDNU-02 manual, appendix E.

/// Returns true if it begins like such a line.
bool looks_like_yacht_devices(std::string_view line) noexcept;

/// The wind in one line. Refusals, in this order: kTooShort (it ends before its identifier), kMalformed (not this
/// format), kNotMine (sent by a program, or another PGN), then as decode_wind_data(). Thread-safe and realtime-safe:
/// yes.
Result<BusWind, Refusal> decode_yacht_devices(std::string_view line) noexcept;

}  // namespace yuragi::drivers::decode::marine
