#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "drivers/decode/byte_order.hpp"
#include "drivers/decode/decoded_wind.hpp"

namespace yuragi::drivers::decode::marine {

// NMEA 2000, PGN 130306 "Wind Data": one CAN frame, no fast packet.
//
//   byte   content
//   0      sequence id
//   1, 2   speed, u16 little-endian, 0.01 m/s
//   3, 4   angle, u16 little-endian, 0.0001 rad, clockwise
//   5      bits 0 to 2: what the angle counts from (WindDataReference); the others are reserved
//   6, 7   reserved
//
// 0xFFFD to 0xFFFF stand for no value. Sources: drivers/SOURCES.md S11.

inline constexpr std::uint32_t kWindDataPgn = 130306;

/// The reference of the angle, by its number in the frame.
enum class WindDataReference : std::uint8_t {
  kNorth,     ///< geographic north
  kMagnetic,  ///< magnetic north
  kApparent,  ///< the bow, of the wind that is felt on board
  kBoat,      ///< the bow, with the vessel's motion over the ground taken out
  kWater,     ///< the bow, with the vessel's motion through the water taken out
  kUnknown,   ///< not sent (7): for a fixed device its own mark
};
inline constexpr std::array<std::string_view, 6> kWindDataReferenceNames = {"north", "magnetic", "apparent",
                                                                            "boat",  "water",    "unknown"};

/// The wind that one device on the bus reports.
struct BusWind {
  DecodedWind wind;
  WindDataReference reference = WindDataReference::kUnknown;
  std::uint8_t address = 0;  ///< of the device on the bus
};

/// Returns the same in the terms of all decoders: a true wind is measured from the bow.
WindReference wind_reference_of(WindDataReference reference) noexcept;

/// A direction in degrees of an angle in radians in [0, 2 pi], as it is rounded to 0.0001; empty for any other.
std::optional<double> direction_of_angle_deg(double angle_rad) noexcept;

/// The wind in a frame's data bytes. Refusals, in this order: kTooShort (less than 6), kMalformed (more than 8, or a
/// reference that is none), kInvalid (no speed), kImplausible. An angle beyond a whole turn leaves the speed, marked
/// uncertain. Thread-safe and realtime-safe: yes.
Result<BusWind, Refusal> decode_wind_data(std::uint8_t address, ByteSpan data) noexcept;

}  // namespace yuragi::drivers::decode::marine
