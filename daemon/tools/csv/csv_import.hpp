#pragma once

#include <cstddef>
#include <functional>
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/tools/csv/csv_options.hpp"
#include "engine/base/result.hpp"
#include "engine/wind/wind_reading.hpp"

namespace yuragi::daemon::tools::csv {

struct CsvImportReport {
  std::vector<std::string> columns;  ///< how each column was understood, a line each
  std::size_t rows = 0;              ///< below the header
  std::size_t taken = 0;
  std::vector<std::string> first_refusals;  ///< "FILE:LINE: what is wrong", at most kMaxRefusalsListed

  std::size_t refused() const { return rows - taken; }
  static constexpr std::size_t kMaxRefusalsListed = 5;
};

/// Called for each reading, with the name of its sensor. May throw, which ends the import.
using CsvReadingSink = std::function<void(std::string_view sensor, const wind::WindReading& reading)>;

/// Reads a CSV file with a header: each row is a reading with UTC, and with a monotonic time that begins at zero. Rows
/// that are not valid readings, or go back in time, are refused and counted. A decimal comma is understood where the
/// delimiter is another character.
///
/// `name` is the file name in messages. `in` is read once, in blocks, and may contain any bytes. Fails where the header
/// is not understood, where a line is longer than kLongestLine, or at the first refused row if `strict`. Thread-safe:
/// yes, with separate streams.
Result<CsvImportReport, Failure> import_csv(std::istream& in, const std::string& name, const CsvImportOptions& options,
                                            const CsvReadingSink& sink);

}  // namespace yuragi::daemon::tools::csv
