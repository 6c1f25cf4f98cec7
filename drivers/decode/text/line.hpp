#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "drivers/decode/decoded_wind.hpp"
#include "drivers/decode/text_fields.hpp"

namespace yuragi::drivers::decode::text {

// Numbers that a microcontroller prints, one reading a line:
//
//   4.2,270,6.1                          columns
//   speed=4.2 direction=270; gust=6.1    keys; ':' does as well as '=', and blank, tab, ',', ';' and '&' separate
//   WindSpeed    = 4.2                   the same, with blanks around the sign, and one value a line
//   speed: 15.1 km/h, direction: 270 deg    the same, with units: one in the line counts before the configured one
//   {"wind": {"speed": 4.2}}             JSON; a key is a name, or a JSON pointer (RFC 6901) such as /wind/speed
//
// There is no standard: the options define the columns or keys. "nan", as Arduino's Serial.print writes it, an empty
// field and "null" mean that the value is not known. Units of speed: those of drivers/decode/speed_units.hpp; of
// direction: deg, degrees and the degree sign. A direction can be a compass point ("NW", in capitals or not), to which
// scale and offset do not apply; "VRB" means that it varies, and is not known.

enum class LineFormat : std::uint8_t {
  kAuto,  ///< JSON if the line begins with '{', keys if it has '=' or ':', otherwise columns
  kColumns,
  kKeys,
  kJson,
};

/// The column or key of a quantity, and its scale: value * scale + offset is in its unit, of which one is `unit` m/s or
/// degrees.
struct LineQuantity {
  std::optional<std::size_t> column;  ///< from 0; none: the line never has it as a column
  std::string key;                    ///< exact; empty: the line never has it as a key
  double scale = 1.0;
  double offset = 0.0;
  double unit = 1.0;
};

struct LineOptions {
  LineFormat format = LineFormat::kAuto;
  char separator = ',';  ///< of columns; a blank stands for any number of blanks and tabs
  LineQuantity speed = {.column = 0, .key = "speed"};
  LineQuantity direction = {.column = 1, .key = "direction"};
  LineQuantity gust = {.column = 2, .key = "gust"};
  std::optional<double> invalid;  ///< the number, unscaled, that means "no value" (-999, say)
  WindReference reference = WindReference::kUnknown;
};

/// What one line has. A quantity that it names may be without a value: "direction=nan". Lines of columns name all
/// quantities that have a column, also if they end before it.
struct LineWind {
  DecodedWind wind = {};  ///< as checked(), but it can be without any value
  bool names_speed = false;
  bool names_direction = false;
  bool names_gust = false;
  std::optional<Refusal> direction_refusal = {};  ///< why the direction cannot be read; then the wind is kUncertain
};

/// The quantities in one line, or why they cannot be read: kTooShort (an empty line), kNotMine (a comment: it begins
/// with '#'; or it has none of the keys), kMalformed (speed or gust is not a number, a key comes twice, the line ends
/// before all of the columns, a control character, or invalid JSON), kImplausible. An unknown unit is kMalformed if it
/// stands at the number itself. Lines that end before a column leave it empty. A direction never discards the others.
/// Thread-safe: yes. Realtime-safe: yes, except JSON, which allocates.
Result<LineWind, Refusal> read_line(const LineOptions& options, std::string_view line) noexcept;

/// The wind in one line, by itself: as read_line(); without any value kInvalid, or why the direction cannot be read.
Result<DecodedWind, Refusal> decode_line(const LineOptions& options, std::string_view line) noexcept;

}  // namespace yuragi::drivers::decode::text
