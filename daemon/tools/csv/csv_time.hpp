#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "engine/base/time.hpp"

namespace yuragi::daemon::tools::csv {

/// The format of times in a CSV file.
enum class TimeFormat : std::uint8_t {
  kAuto,        ///< guessed from all rows
  kIso,         ///< the year first: 2018-07-20T14:00:00.1Z, 2018/7/20 2:00 PM, 20180720 1400, 20180720:1400, 2018-201
                ///< (day of the year); or the month by its name
  kDayFirst,    ///< 20/07/2018 14:00, 20.7.18 14:00, 20-Jul-2018 02:00:00 PM
  kMonthFirst,  ///< 07/20/2018 14:00, 7/20/18 2:00 PM, 7/20/18 2:00p
  kCompact,     ///< digits alone: YYYYMMDD, YYYYMMDDHH, YYYYMMDDHHMM, YYYYMMDDHHMMSS
  kUnix,        ///< seconds since 1970
  kUnixMs,      ///< milliseconds since 1970
  kUnixUs,      ///< microseconds since 1970
  kUnixNs,      ///< nanoseconds since 1970
  kSeconds,     ///< seconds since an unknown moment, taken as 1970
};
inline constexpr std::size_t kCsvTimeFormatCount = 10;

std::string_view name_of(TimeFormat format);

/// Returns true for a format of date and time of day, which gives a moment only together with a zone.
constexpr bool is_calendar(TimeFormat format) {
  return format == TimeFormat::kIso || format == TimeFormat::kDayFirst || format == TimeFormat::kMonthFirst ||
         format == TimeFormat::kCompact;
}

/// A time as it is written.
struct Time {
  UtcTime clock;                          ///< what the clock showed, as if it were UTC
  std::optional<Nanoseconds> utc_offset;  ///< how far it was ahead of UTC, if the text states it
  bool operator==(const Time&) const = default;
};

/// The format of a number of seconds, milliseconds ... by its size; nullopt if it is not a number.
std::optional<TimeFormat> guess_count_format(std::string_view text);

/// A decimal number times 10^decimals, exactly: ("1.25", 9) and ("1,25", 9) are 1250000000. Further digits are cut off.
/// Nullopt if the text is not a number, or does not fit into 64 bits.
std::optional<std::int64_t> parse_decimal(std::string_view text, int decimals);

/// Nullopt if the text is not a time of this format (not kAuto), or outside the range of a recording. Zones: Z, UTC,
/// GMT, +02:00, +0200, UTC+2. An hour of 24 is the next day's first. Years of two digits are 1970 to 2069.
std::optional<Time> parse_time(std::string_view text, TimeFormat format);

/// Returns true if the text has a day, as a date or as seconds since 1970; a time of day alone has none.
bool has_date(std::string_view text);

}  // namespace yuragi::daemon::tools::csv
