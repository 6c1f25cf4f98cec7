#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "engine/base/time.hpp"

namespace yuragi::daemon::tools::csv {

/// The format of times in a CSV file.
enum class CsvTimeFormat : std::uint8_t {
  kAuto,     ///< guessed from the first row
  kIso,      ///< 2018-07-20T14:00:00.1Z, with or without T, seconds, fraction and zone; UTC where it names none
  kUnix,     ///< seconds since 1970
  kUnixMs,   ///< milliseconds since 1970
  kSeconds,  ///< seconds since an unknown moment, taken as 1970
};

std::string_view name_of(CsvTimeFormat format);

/// Guesses the format of a time: ISO if it is not a number, otherwise by its size.
CsvTimeFormat guess_time_format(std::string_view text);

/// A decimal number times 10^decimals, exactly: ("1.25", 9) and ("1,25", 9) are 1250000000. Further digits are cut off.
/// Nothing if the text is not a number, or does not fit into 64 bits.
std::optional<std::int64_t> parse_decimal(std::string_view text, int decimals);

/// Nothing if the text is not a time of this format (not kAuto), or outside the range of a recording.
std::optional<UtcTime> parse_time(std::string_view text, CsvTimeFormat format);

}  // namespace yuragi::daemon::tools::csv
