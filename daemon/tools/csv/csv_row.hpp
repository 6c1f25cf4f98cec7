#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/tools/csv/csv_fields.hpp"
#include "daemon/tools/csv/csv_survey.hpp"
#include "daemon/tools/csv/csv_zone.hpp"
#include "engine/base/result.hpp"
#include "engine/wind/station_quantities.hpp"
#include "engine/wind/wind_reading.hpp"

namespace yuragi::daemon::tools::csv {

/// The content of a row.
struct Row {
  wind::Reading reading;
  std::optional<wind::StationQuantities> quantities;  ///< at the reading's time, as far as they are plausible
};

/// Converts the rows of one CSV file to readings. Thread-safe: no.
class RowReader {
 public:
  /// Fails if the file names an unknown zone.
  static Result<RowReader, Failure> make(const Layout& layout, const Survey& survey, const ImportOptions& options);

  /// The reading in a row, or why it is refused. Call it in the order of time.
  Result<Row, RowRefusal> read(const Fields& fields);

  /// How each column was understood, a line each; complete after the last row.
  std::vector<std::string> describe() const;
  /// Parts omitted from accepted rows, and remarks about their times.
  std::vector<std::string> notes() const;

 private:
  RowReader(const Layout& layout, const Survey& survey, const ImportOptions& options)
      : columns_(layout.columns), survey_(survey), options_(options) {}

  Result<Instant, RowRefusal> read_time(const Fields& fields);
  /// The number in its base unit.
  Result<std::optional<double>, RowRefusal> read_number(const Fields& fields, Role role);
  Result<std::optional<double>, RowRefusal> read_speed(const Fields& fields, Role role);
  std::optional<double> read_direction(std::string_view text);
  Result<void, RowRefusal> read_wind(const Fields& fields, wind::Reading& reading);
  Result<void, RowRefusal> read_packed_wind(std::string_view text, wind::Reading& reading);
  std::optional<wind::StationQuantities> read_quantities(const Fields& fields, const Instant& time);
  bool is_missing(Role role, std::string_view text) const;
  Unit unit_of(Role role) const;
  std::string describe_time() const;
  /// The clock of a time, in the year that all months of a typical one are put on.
  UtcTime in_typical_year(UtcTime clock) const;

  const Columns& columns_;
  const Survey& survey_;
  const ImportOptions& options_;
  Zone zone_;
  std::string zone_source_;
  std::optional<UtcTime> first_utc_;
  std::optional<UtcTime> last_utc_;
  MonoTime last_{};
  std::size_t zoned_ = 0;  ///< times that named their zone
  std::size_t unzoned_ = 0;
  std::size_t same_time_ = 0;  ///< readings at the time of the one before
  std::size_t went_back_ = 0;
  std::map<std::string, std::size_t, std::less<>> odd_directions_;  ///< texts that are none, the first few
  std::array<std::size_t, kCsvRoleCount> missing_{};                ///< values that were left out
  std::size_t implausible_quantities_ = 0;
};

}  // namespace yuragi::daemon::tools::csv
