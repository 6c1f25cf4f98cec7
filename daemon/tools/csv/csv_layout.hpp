#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "daemon/tools/csv/csv_options.hpp"
#include "engine/base/result.hpp"

namespace yuragi::daemon::tools::csv {

/// The position of the table in a CSV file, and its columns.
struct Layout {
  char delimiter = ',';
  std::vector<std::string> header;
  std::size_t first_row = 0;        ///< the number of its line, from 1
  std::vector<std::string> row;     ///< the first one's fields
  Columns columns;                  ///< with units and zone from name, row of units or preamble
  bool may_rows_be_longer = false;  ///< further columns are ignored
  std::string_view without_units;   ///< the program that wrote the file without units; empty if it is not known
  std::vector<std::string> notes;   ///< information from the lines around the header
};

/// Finds the header in the first lines of a file: the first line that names a time and a wind, above a row that has
/// them; else a line and the one above it, together (Davis); else a comment (KNMI, NDBC). A line with a number, a date
/// or a byte in hexadecimal digits is no header. Rows of units below the header, and a preamble above it that names a
/// zone or a unit, are understood. Fails as choose_columns() does, with the columns of the line that looks most like a
/// header. Thread-safe: yes.
Result<Layout, Failure> find_layout(const std::vector<std::string>& lines, const ImportOptions& options);

}  // namespace yuragi::daemon::tools::csv
