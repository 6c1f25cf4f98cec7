#pragma once

#include <optional>
#include <string_view>

#include "daemon/tools/csv/csv_time.hpp"
#include "engine/base/time.hpp"

namespace yuragi::daemon::tools::logs {

/// The clock that a log of NMEA 0183 has in itself: RMC and ZDA have date and time, GLL and GGA the time of the day of
/// the last date. Source: gpsd www/NMEA.adoc. Thread-safe: no.
class NmeaClock {
 public:
  /// Takes any line; true if it set the clock.
  bool take(std::string_view line);
  /// The last received time; nullopt before the first date.
  std::optional<UtcTime> now() const { return now_; }

 private:
  bool set_time_of_day(Nanoseconds time_of_day);

  std::optional<std::chrono::sys_days> day_;
  std::optional<UtcTime> now_;
};

/// "17:33:21.179", "173321.107": since midnight. Nullopt if it is no such time.
std::optional<Nanoseconds> time_of_day_in(std::string_view text);

/// The time that a logger wrote before a message: "2023-06-25 22:00:00.5,", "[1687730400.25] ", "1687730400153;A;", or
/// the "c:" of an NMEA 4 tag block. Nullopt if it is not a time with a date. `format`: kAuto takes ISO 8601, digits and
/// Unix times, but no dates of which day and month could be either.
std::optional<csv::Time> leading_time(std::string_view prefix, csv::TimeFormat format);

}  // namespace yuragi::daemon::tools::logs
