#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/tools/csv/csv_import.hpp"
#include "daemon/tools/csv/csv_options.hpp"
#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi::daemon::tools::logs {

struct Options {
  csv::ImportOptions table;             ///< of keys and their units; of times: zone and format; sensor and strictness
  std::optional<UtcTime> start;         ///< of the first reading, if the log has no times
  std::optional<Nanoseconds> interval;  ///< from one reading to the next, if the log has no times
  std::string sentence;                 ///< take this source ("MWD"); empty: the best that the log has
};

/// Returns true if the first lines of a file look like a log of messages (MessageFinder), not a table.
bool looks_like_log(const std::vector<std::string>& lines, const csv::ImportOptions& options);

/// Reads a log of an anemometer's messages (MessageFinder): each reading has the time that the logger wrote before it,
/// or the one that the message has itself, or the last one of the log's own RMC, ZDA, GLL or GGA, or `start` and a
/// number of `interval`s. A device sends one measurement in several sentences: one of them is taken, of the frequent
/// ones the one whose angle is from north.
///
/// Fails, with the option that helps, if no line has a wind or no time is found. Otherwise as
/// import_csv().
Result<csv::ImportReport, Failure> import_log(csv::Input& input, const std::string& name, const Options& options,
                                              const csv::Sinks& sinks);

}  // namespace yuragi::daemon::tools::logs
