#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/csv_columns.hpp"
#include "daemon/csv_time.hpp"
#include "engine/base/result.hpp"
#include "engine/wind/wind_reading.hpp"

namespace yuragi {

/// In what a CSV file gives directions.
enum class CsvDirectionUnit : std::uint8_t {
  kAuto,  ///< radians if the column's name says so, or else degrees
  kDegrees,
  kRadians,
  kPoint16,  ///< 0 to 15, clockwise from north, 22.5 degrees each; names (NNE) are always understood
};

struct CsvImportOptions {
  CsvColumnNames columns;  ///< the user's names; empty ones are guessed
  CsvTimeFormat time_format = CsvTimeFormat::kAuto;
  std::optional<SpeedUnit> unit;  ///< of speed, gust, u and v; empty: as the column's name says, or else m/s
  CsvDirectionUnit direction_unit = CsvDirectionUnit::kAuto;
  bool direction_is_toward = false;  ///< the column says where the wind blows to
  bool components_are_from = false;  ///< u and v point to where the wind comes from
  char delimiter = 0;                ///< ',', ';' or tab; 0: whichever the header has most of
  char comment = '#';                ///< lines that begin with it are passed over; 0: none are
  std::string sensor = "imported";   ///< what the readings' sensor is called, unless the file is our own export
  bool strict = false;               ///< fail at the first row that is refused
};

struct CsvImportReport {
  std::vector<std::string> columns;  ///< what was taken as what, a line each
  std::size_t rows = 0;              ///< below the header
  std::size_t taken = 0;
  std::vector<std::string> first_refusals;  ///< "FILE:LINE: what is wrong", at most kMaxRefusalsTold

  std::size_t refused() const { return rows - taken; }
  static constexpr std::size_t kMaxRefusalsTold = 5;
};

/// Takes each reading, with the name of its sensor. May throw; the import ends with that.
using CsvReadingSink = std::function<void(std::string_view sensor, const WindReading& reading)>;

/// Reads a CSV file with a header: each row is a reading with UTC, and with a monotonic time that begins at zero. Rows
/// that are no readings, or go back in time, are refused and counted. A decimal comma is understood where the delimiter
/// is another sign.
///
/// `name` stands in messages. `in` is read once, in blocks. Believes nothing: any bytes may come. Fails where there is
/// no header that can be understood, or where a line is endless, or at the first bad row if `strict`. Thread-safe: yes,
/// with streams of their own.
Result<CsvImportReport, Failure> import_csv(std::istream& in, const std::string& name, const CsvImportOptions& options,
                                            const CsvReadingSink& sink);

}  // namespace yuragi
