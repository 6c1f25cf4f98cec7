#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "daemon/tools/csv/csv_columns.hpp"
#include "daemon/tools/csv/csv_time.hpp"
#include "daemon/tools/csv/csv_units.hpp"
#include "daemon/tools/csv/csv_zone.hpp"

namespace yuragi::daemon::tools::csv {

/// The unit of directions in a CSV file.
enum class DirectionUnit : std::uint8_t {
  kAuto,  ///< radians if the column's name states it, or else degrees
  kDegrees,
  kRadians,
  kPoint16,  ///< 0 to 15, clockwise from north, 22.5 degrees each; names (NNE) are always understood
};

/// Rows are taken if this column has this text.
struct Condition {
  std::string column;
  std::string value;
};

struct ImportOptions {
  ColumnNames columns;  ///< the user's names; empty ones are guessed
  TimeFormat time_format = TimeFormat::kAuto;
  std::optional<Zone> zone;       ///< of times that name none; nullopt: given in the file, or else UTC
  std::optional<Unit> unit;       ///< of speed, gust, u, v and w; nullopt: given in the file, or else m/s
  std::optional<Unit> gust_unit;  ///< of the gust alone
  DirectionUnit direction_unit = DirectionUnit::kAuto;
  bool direction_is_toward = false;   ///< directions are where the wind blows to
  bool components_are_from = false;   ///< u and v point to where the wind comes from
  char delimiter = 0;                 ///< ',', ';', '|', tab, or ' ' (any blanks); 0: as the header has it
  char comment = '#';                 ///< lines that begin with it are skipped; 0: none are
  std::optional<std::size_t> skip;    ///< number of lines before the header; nullopt: it is searched for
  std::vector<std::string> header;    ///< the names of the columns of a file without a header; empty: it has one
  std::vector<Condition> conditions;  ///< all are to hold
  std::vector<std::string> missing;   ///< further texts that stand for no value ("99.0")
  std::string sensor = "imported";    ///< name of the sensor, unless the file is an export of yuragi's
  bool strict = false;                ///< fail at the first row that is refused
};

}  // namespace yuragi::daemon::tools::csv
