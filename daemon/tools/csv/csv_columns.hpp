#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/tools/csv/csv_role.hpp"
#include "daemon/tools/csv/csv_units.hpp"
#include "engine/base/result.hpp"

namespace yuragi::daemon::tools::csv {

/// The header that `yuragi export` writes; `yuragi import` recognizes it without options.
inline constexpr std::string_view kExportedHeader = "utc,time_s,sensor,speed_m_s,direction_deg,gust_m_s,quality";

/// The values of its column `quality`, by ReadingQuality.
inline constexpr std::array<std::string_view, 3> kQualityWords = {"good", "uncertain", "simulated"};

/// A column that was found.
struct Column {
  std::string name;          ///< as in the header
  std::size_t index = 0;     ///< in the header, from 0
  std::optional<Unit> unit;  ///< of its numbers; empty: not known
  std::string unit_source;   ///< where that is from: "by its name"
  std::string unknown_unit;  ///< a word in the place of a unit that is none that is known
};

/// How a part of a time stands in its column.
enum class TimePartForm : std::uint8_t {
  kText,             ///< as parse_time() takes it
  kDayOfYear,        ///< 1 to 366, behind the year
  kHoursAndMinutes,  ///< a number without leading zeros: 5 is 00:05, 1340 is 13:40
};

struct TimePart {
  std::size_t column = 0;
  TimePartForm form = TimePartForm::kText;
};

/// The columns of a file.
struct Columns {
  std::array<std::optional<Column>, kCsvRoleCount> by_role;
  /// Those that a time is put together from: one, a date and a time, year and day of the year with a time, or year,
  /// month, day, hour, minute, second.
  std::vector<TimePart> time_parts;
  std::optional<std::string> zone;   ///< in which the times are, by the name of their column
  std::optional<bool> is_day_first;  ///< of dates, by the name of their column ("DATE (MM/DD/YYYY)")
  std::vector<std::string> unused;   ///< the names of those that have no role
  const std::optional<Column>& at(Role role) const { return by_role[static_cast<std::size_t>(role)]; }
  std::optional<Column>& at(Role role) { return by_role[static_cast<std::size_t>(role)]; }
};

/// The names that the user gave, by role; empty if none.
using ColumnNames = std::array<std::string, kCsvRoleCount>;

/// Finds the columns: by the given names, ignoring case, and otherwise by the names that loggers commonly use. `row`:
/// the fields of the first row, if there is one: they settle whether a time needs its date from another column, and
/// whether a column without a name has times. Fails, with a list of the columns, without a time, without a speed or
/// both u and v, or with two columns of one name.
Result<Columns, Failure> choose_columns(const std::vector<std::string>& header, const ColumnNames& given,
                                        const std::vector<std::string>& row = {});

/// The same for the keys of a message, whose time can stand elsewhere. Fails without a given speed. Names of one letter
/// are no speed.
Result<Columns, Failure> choose_keys(const std::vector<std::string>& keys, const ColumnNames& given,
                                     const std::vector<std::string>& values);

}  // namespace yuragi::daemon::tools::csv
