#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/tools/csv/csv_columns.hpp"

namespace yuragi::daemon::tools::csv {

// Files that are known by their first lines. Sources: drivers/SOURCES.md S12.

/// A table whose columns stand in no single line.
struct KnownTable {
  std::string_view program = {};         ///< who writes it
  std::vector<std::string> header = {};  ///< the names of its first columns
  std::size_t first_row = 0;             ///< the index of its line
  bool is_without_units = false;         ///< they are settings of the program that wrote it
};

/// EnergyPlus weather (EPW), CumulusMX's monthly logs, and what the Japan Meteorological Agency gives for download.
/// Thread-safe: yes.
std::optional<KnownTable> find_known_table(const std::vector<std::string>& lines);

/// The zone that the first line of a typical year has as a number of hours: EPW, TMY3. Thread-safe: yes.
std::optional<std::string> zone_of_first_line(const std::vector<std::string>& lines);

/// The columns of a file of an NRG logger, whose names begin with channels ("Ch12_Samples_Deg"): a vane, and the
/// anemometer that the lines before the header pair with it; or else the first of each. Empty for any other file.
/// Thread-safe: yes.
ColumnNames columns_of_channels(const std::vector<std::string>& lines, const std::vector<std::string>& header);

}  // namespace yuragi::daemon::tools::csv
