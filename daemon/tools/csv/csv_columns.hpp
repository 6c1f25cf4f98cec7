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

namespace yuragi {

/// What a column of a CSV file can be to us.
enum class CsvRole : std::uint8_t { kTime, kElapsed, kSpeed, kDirection, kGust, kU, kV, kQuality, kSensor };
inline constexpr std::size_t kCsvRoleCount = 9;

std::string_view name_of(CsvRole role);

/// The header of what `yuragi export` writes, which `yuragi import` takes without being told anything.
inline constexpr std::string_view kExportedHeader = "utc,time_s,sensor,speed_m_s,direction_deg,gust_m_s,quality";

/// The words of its column `quality`, by ReadingQuality.
inline constexpr std::array<std::string_view, 3> kQualityWords = {"good", "uncertain", "simulated"};

/// By one of the names that people give it ("km/h", "kn", "kts", "mph"), in small letters, signs left out or not.
std::optional<SpeedUnit> find_speed_unit(std::string_view name);

/// A column that was found.
struct CsvColumn {
  std::string name;               ///< as the header has it
  std::size_t index = 0;          ///< in the header, from 0
  std::optional<SpeedUnit> unit;  ///< of a speed; empty: its name does not tell
  bool is_in_radians = false;     ///< by its name
  bool is_in_ms = false;          ///< by its name: a time in milliseconds
};

/// The columns, by role.
using CsvColumns = std::array<std::optional<CsvColumn>, kCsvRoleCount>;

/// The names that the user gave, by role; empty where none.
using CsvColumnNames = std::array<std::string, kCsvRoleCount>;

/// Finds out which column is what: by the given names, in large or small letters, and otherwise by what loggers
/// commonly call them. Time and either a speed or both u and v there must be, and no two columns of
/// the same name; the failure lists what there is.
Result<CsvColumns, Failure> choose_columns(const std::vector<std::string>& header, const CsvColumnNames& given);

}  // namespace yuragi
