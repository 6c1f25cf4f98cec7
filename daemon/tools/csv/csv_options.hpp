#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "daemon/tools/csv/csv_columns.hpp"
#include "daemon/tools/csv/csv_time.hpp"

namespace yuragi::daemon::tools::csv {

/// The unit of directions in a CSV file.
enum class CsvDirectionUnit : std::uint8_t {
  kAuto,  ///< radians if the column's name says so, or else degrees
  kDegrees,
  kRadians,
  kPoint16,  ///< 0 to 15, clockwise from north, 22.5 degrees each; names (NNE) are always understood
};

struct CsvImportOptions {
  CsvColumnNames columns;  ///< the user's names; empty ones are guessed
  CsvTimeFormat time_format = CsvTimeFormat::kAuto;
  /// Of speed, gust, u and v; empty: as the column's name says, or else m/s.
  std::optional<drivers::sensor::SpeedUnit> unit;
  CsvDirectionUnit direction_unit = CsvDirectionUnit::kAuto;
  bool direction_is_toward = false;  ///< directions are where the wind blows to
  bool components_are_from = false;  ///< u and v point to where the wind comes from
  char delimiter = 0;                ///< ',', ';' or tab; 0: the one most frequent in the header
  char comment = '#';                ///< lines that begin with it are skipped; 0: none are
  std::string sensor = "imported";   ///< name of the sensor, unless the file is an export of yuragi's
  bool strict = false;               ///< fail at the first row that is refused
};

}  // namespace yuragi::daemon::tools::csv
