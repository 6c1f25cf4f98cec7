#pragma once

#include <cstddef>
#include <functional>
#include <iosfwd>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/tools/csv/csv_fields.hpp"
#include "daemon/tools/csv/csv_input.hpp"
#include "daemon/tools/csv/csv_options.hpp"
#include "engine/base/result.hpp"
#include "engine/wind/station_quantities.hpp"
#include "engine/wind/wind_reading.hpp"

namespace yuragi::daemon::tools::csv {

struct ImportReport {
  std::vector<std::string> columns;  ///< how each column was understood, a line each
  std::vector<std::string> notes;    ///< what was settled, guessed or left out besides, a line each
  std::size_t rows = 0;              ///< below the header, without those that a condition leaves out
  std::size_t taken = 0;
  std::size_t quantities = 0;                   ///< rows with something besides the wind
  std::vector<std::string> first_refusals;      ///< "FILE:LINE: what is wrong", at most kMaxRefusalsListed
  std::map<std::string, std::size_t> refusals;  ///< how many rows were left out, by reason

  bool is_own_export = false;  ///< what `yuragi export` wrote: nothing was guessed

  std::size_t refused() const { return rows - taken; }
  /// Counts a row that is left out.
  void refuse(const std::string& file, std::size_t line, const RowRefusal& why);
  static constexpr std::size_t kMaxRefusalsListed = 5;
};

/// What takes the readings, each with the name of its sensor. May throw, which ends the import.
struct Sinks {
  std::function<void(std::string_view sensor, const wind::Reading& reading)> reading;
  /// After the reading of the same time; can be empty.
  std::function<void(std::string_view sensor, const wind::StationQuantities& quantities)> quantities = {};
};

/// Reads a CSV file with a header: each row is a reading with UTC, and with a monotonic time that begins at zero. Rows
/// that are not valid readings, or go back in time, are refused and counted; a file with its newest row first is read
/// from its end. A decimal comma is understood if the delimiter is another character.
///
/// `name` is the file name in messages. The input may contain any bytes; it is read twice if it can be rewound,
/// and is otherwise kept as far as Input::kMaxKept. Memory does not depend on the file's length, except for 24
/// bytes a row of a file with its newest row first. Fails if the header, the dates or the units are not understood (the
/// message names the option that helps), if a line is longer than kMaxLine, or at the first refused row if
/// `strict`. Thread-safe: yes, with separate streams.
Result<ImportReport, Failure> import_csv(Input& input, const std::string& name, const ImportOptions& options,
                                         const Sinks& sinks);
Result<ImportReport, Failure> import_csv(std::istream& in, const std::string& name, const ImportOptions& options,
                                         const Sinks& sinks);

}  // namespace yuragi::daemon::tools::csv
