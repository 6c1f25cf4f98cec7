#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/tools/csv/csv_options.hpp"
#include "engine/base/result.hpp"
#include "engine/wind/wind_reading.hpp"

namespace yuragi::daemon::tools::csv {

/// The fields of a row, by role; none for a missing column.
using CsvFields = std::array<std::optional<std::string_view>, kCsvRoleCount>;

/// Converts the rows of one CSV file to readings. Thread-safe: no.
class CsvRowReader {
 public:
  CsvRowReader(const CsvColumns& columns, const CsvImportOptions& options);

  /// The reading in a row, or why it is refused. To be called in the order of the file.
  Result<wind::WindReading, Failure> read(const CsvFields& fields);

  /// How each column was understood, a line each; complete after the first row.
  std::vector<std::string> describe() const;

 private:
  double unit_of(CsvRole role) const;
  Result<Instant, Failure> read_time(const CsvFields& fields);
  Result<std::optional<double>, Failure> read_speed(const CsvFields& fields, CsvRole role) const;
  Result<std::optional<double>, Failure> read_direction(std::string_view text) const;
  Result<void, Failure> read_wind(const CsvFields& fields, wind::WindReading& reading) const;

  CsvColumns columns_;
  CsvImportOptions options_;
  CsvTimeFormat time_format_;
  std::optional<UtcTime> first_utc_;
  MonoTime last_{};
};

}  // namespace yuragi::daemon::tools::csv
