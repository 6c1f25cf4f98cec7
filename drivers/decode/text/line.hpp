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
//   4.2,270,6.1                      columns
//   speed=4.2 direction=270; gust=6.1    keys; ':' does as well as '=', and blank, tab, ',', ';' and '&' separate
//     speed: 15.1 km/h, direction: 270 deg    the same, with units: one in the line counts before the configured
//   one
//   {"wind": {"speed": 4.2}}             JSON; a key is a name, or a JSON pointer (RFC 6901) such as /wind/speed
//
// There is no standard: the options define the columns or keys. "nan", as Arduino's Serial.print writes it, an empty
// field and "null" mean that the value is not known. Units of speed: those of drivers/decode/speed_units.hpp; of
// direction: deg, degrees and the degree sign.

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

/// The wind in one line, or why there is none: kTooShort (an empty line), kNotMine (a comment: it begins with '#'; or
/// it has none of the keys), kMalformed (a value is not a number, a key comes twice, or invalid JSON), kInvalid (no
/// value), kImplausible. An unknown unit is kMalformed if it stands at the number itself. Lines that end before a
/// column leave it empty. Thread-safe: yes. Realtime-safe: yes, except JSON, which allocates.
Result<DecodedWind, Refusal> decode_line(const LineOptions& options, std::string_view line) noexcept;

}  // namespace yuragi::drivers::decode::text
