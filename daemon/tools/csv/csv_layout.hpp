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
  std::size_t first_row = 0;       ///< the number of its line, from 1
  std::vector<std::string> row;    ///< the first one's fields
  Columns columns;                 ///< with units and zone from name, row of units or preamble
  std::vector<std::string> notes;  ///< information from the lines around the header
};

/// Finds the header in the first lines of a file: the first line that names a time and a wind; else a line and the one
/// above it, together (Davis); else a comment (KNMI, NDBC). Rows of units below the header, and a preamble above it
/// that names a zone or a unit, are understood. Fails as choose_columns() does. Thread-safe: yes.
Result<Layout, Failure> find_layout(const std::vector<std::string>& lines, const ImportOptions& options);

}  // namespace yuragi::daemon::tools::csv
