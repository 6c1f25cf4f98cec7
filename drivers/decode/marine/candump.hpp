#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "drivers/decode/marine/wind_data.hpp"

namespace yuragi::drivers::decode::marine {

// Frames as can-utils' candump writes them, a line each: with -L or -l, as the driver shows those of a CAN interface,
// and without. A time in parentheses may stand before the interface.
//
//   (1436509052.249713) can0 09FD0205#641E01C8F1FAFFFF
//   can0  09FD0205   [8]  64 1E 01 C8 F1 FA FF FF
//   can0  20000004   [8]  00 10 00 00 00 00 00 00   ERRORFRAME
//
// Identifiers of 8 digits have 29 bits, those of 3 digits 11, which NMEA 2000 does not use. From 20000000 on they are
// not frames of the bus, but reports of its controller about itself. Sources: drivers/SOURCES.md S11.

/// The state of a CAN controller, as it reports it.
enum class ControllerState : std::uint8_t {
  kGood,
  kPassive,  ///< after so many errors that it must not disturb others any more; it still receives
  kBusOff,   ///< after so many errors that it does not take part in the bus
};

/// Returns true if it begins like such a line.
bool looks_like_candump(std::string_view line) noexcept;

/// Returns the controller's state in a line; nullopt if it is another line. Thread-safe and realtime-safe: yes.
std::optional<ControllerState> candump_controller_state(std::string_view line) noexcept;

/// The wind in one line. Refusals, in this order: kTooShort (it ends before its data), kMalformed (not this format),
/// kException (the controller's own), kNotMine (11 bits, a remote frame, CAN FD, another PGN), then as
/// decode_wind_data(). Thread-safe and realtime-safe: yes.
Result<BusWind, Refusal> decode_candump(std::string_view line) noexcept;

}  // namespace yuragi::drivers::decode::marine
