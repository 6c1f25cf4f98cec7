#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/tools/csv/csv_import.hpp"
#include "daemon/tools/csv/csv_options.hpp"
#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi::daemon::tools::csv {

struct LineLogOptions {
  TimeFormat time_format = TimeFormat::kAuto;
  std::optional<Zone> zone;             ///< of times that name none; empty: UTC
  std::optional<UtcTime> start;         ///< of the first reading, if the log has no times
  std::optional<Nanoseconds> interval;  ///< from one reading to the next, if the log has no times
  std::string sentence;                 ///< take this one ("MWD"); empty: the best that the log has
  std::string sensor = "imported";
  bool strict = false;
};

/// Returns true if the first lines of a file look like a log of messages (NMEA 0183, Gill, FT, UMB, keys), not a table.
bool looks_like_line_log(const std::vector<std::string>& lines);

/// Reads a log of an anemometer's messages, one a line: each reading has the time that the logger wrote before it, or
/// the last one of the log's own RMC, ZDA, GLL or GGA, or `start` and a number of `interval`s. A device sends one
/// measurement in several sentences: one of them is taken, of the frequent ones the one whose angle is from north.
///
/// Fails, with the option that helps, if no line has a wind or no time is found. Otherwise as
/// import_csv().
Result<ImportReport, Failure> import_line_log(Input& input, const std::string& name, const LineLogOptions& options,
                                              const Sinks& sinks);

}  // namespace yuragi::daemon::tools::csv
