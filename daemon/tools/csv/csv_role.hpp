#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "daemon/tools/csv/csv_units.hpp"
#include "engine/wind/station_quantities.hpp"

namespace yuragi::daemon::tools::csv {

/// The meanings that a column of a CSV file can have.
enum class CsvRole : std::uint8_t {
  kTime,
  kDate,  ///< the day, if the time stands in another column
  kElapsed,
  kSpeed,
  kDirection,
  kGust,
  kU,
  kV,
  kQuality,
  kSensor,
  kVerticalSpeed,
  kTemperature,
  kPressure,
  kHumidity,
  kRainTotal,
  kRainRate,
};
inline constexpr std::size_t kCsvRoleCount = 16;

/// The roles of what stations report besides the wind, in the order of wind::kStationQuantities.
inline constexpr std::array<CsvRole, 6> kQuantityRoles = {CsvRole::kVerticalSpeed, CsvRole::kTemperature,
                                                          CsvRole::kPressure,      CsvRole::kHumidity,
                                                          CsvRole::kRainTotal,     CsvRole::kRainRate};
static_assert(kQuantityRoles.size() == wind::kStationQuantities.size());

std::string_view name_of(CsvRole role);
CsvDimension dimension_of(CsvRole role);

}  // namespace yuragi::daemon::tools::csv
