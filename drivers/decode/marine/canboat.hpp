#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "drivers/decode/marine/wind_data.hpp"

namespace yuragi::drivers::decode::marine {

// What canboat's analyzer and canboatjs make of NMEA 2000: JSON, one object a line.
//
//   {"version":"4.11.0","units":"std"}
//   {"timestamp":"2020-06-05-18:03:25.626","prio":2,"src":105,"dst":255,"pgn":130306,"description":"Wind Data",
//    "fields":{"SID":0,"Wind Speed":4.01,"Wind Angle":347.4,"Reference":"Apparent"}}
//
// Fields are also named windSpeed or WindSpeed (-camel, -upper-camel), the whole then stands in {"windData": ...};
// the reference may be {"value":2,"name":"Apparent"} (-nv), and numbers may be texts (before 2014). What has no value
// is left out or null. Speeds are in m/s. Angles are in degrees ("units":"std"), or in radians with -si ("si") and from
// canboatjs: the unit is only in the first line, which a later client does not get. Sources: drivers/SOURCES.md S11.

enum class AngleUnit : std::uint8_t { kDegrees, kRadians };

struct CanboatOptions {
  std::optional<AngleUnit> angle_unit;  ///< nullopt: angles too large for radians are in degrees, and other angles
                                        ///< are left out
};

/// Returns the unit in the first line of the analyzer; nullopt if the line has none. Thread-safe: yes.
std::optional<AngleUnit> canboat_angle_unit(std::string_view line);

/// The wind in one line. Refusals, in this order: kMalformed (no JSON object), kNotMine (another PGN, or none),
/// kMalformed (fields of another kind), kInvalid (no speed), kImplausible. An impossible angle leaves the speed, marked
/// uncertain. Never throws for any line, except if memory runs out. Thread-safe: yes.
Result<BusWind, Refusal> decode_canboat(const CanboatOptions& options, std::string_view line);

}  // namespace yuragi::drivers::decode::marine
