#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/sensor/speed_unit.hpp"
#include "engine/base/result.hpp"

namespace yuragi::daemon::tools::csv {

/// The meanings that a column of a CSV file can have.
enum class CsvRole : std::uint8_t { kTime, kElapsed, kSpeed, kDirection, kGust, kU, kV, kQuality, kSensor };
inline constexpr std::size_t kCsvRoleCount = 9;

std::string_view name_of(CsvRole role);

/// The header that `yuragi export` writes; `yuragi import` recognizes it without options.
inline constexpr std::string_view kExportedHeader = "utc,time_s,sensor,speed_m_s,direction_deg,gust_m_s,quality";

/// The values of its column `quality`, by ReadingQuality.
inline constexpr std::array<std::string_view, 3> kQualityWords = {"good", "uncertain", "simulated"};

/// The unit with one of its usual names ("km/h", "kn", "kts", "mph"), in lower case, with or without punctuation.
std::optional<drivers::sensor::SpeedUnit> find_speed_unit(std::string_view name);

/// A column that was found.
struct CsvColumn {
  std::string name;                                ///< as in the header
  std::size_t index = 0;                           ///< in the header, from 0
  std::optional<drivers::sensor::SpeedUnit> unit;  ///< of a speed; empty: not in its name
  bool is_in_radians = false;                      ///< by its name
  bool is_in_ms = false;                           ///< a time in milliseconds, by its name
};

/// The columns, by role.
using CsvColumns = std::array<std::optional<CsvColumn>, kCsvRoleCount>;

/// The names that the user gave, by role; empty where none.
using CsvColumnNames = std::array<std::string, kCsvRoleCount>;

/// Finds the columns: by the given names, ignoring case, and otherwise by the names that loggers commonly use. Fails,
/// with a list of the columns, without a time, without a speed or both u and v, or with two columns of one name.
Result<CsvColumns, Failure> choose_columns(const std::vector<std::string>& header, const CsvColumnNames& given);

}  // namespace yuragi::daemon::tools::csv
