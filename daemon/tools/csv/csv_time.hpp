#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "engine/base/time.hpp"

namespace yuragi {

/// How a CSV file writes its times.
enum class CsvTimeFormat : std::uint8_t {
  kAuto,     ///< whichever the first row looks like
  kIso,      ///< 2018-07-20T14:00:00.1Z, with or without T, seconds, fraction and zone; UTC where it names none
  kUnix,     ///< seconds since 1970
  kUnixMs,   ///< milliseconds since 1970
  kSeconds,  ///< seconds since something that the file does not tell; 1970 is taken for it
};

std::string_view name_of(CsvTimeFormat format);

/// What a time looks like: ISO if it is no number, or else by its size.
CsvTimeFormat guess_time_format(std::string_view text);

/// A decimal number times 10^decimals, exactly, as far as a 64-bit number holds it: ("1.25", 9) is 1250000000, and so
/// is ("1,25", 9). Digits beyond are cut off. Nothing if the text is something else.
std::optional<std::int64_t> parse_decimal(std::string_view text, int decimals);

/// Nothing if the text is no time of this format, which must not be kAuto, or one that no recording can hold.
std::optional<UtcTime> parse_time(std::string_view text, CsvTimeFormat format);

}  // namespace yuragi
