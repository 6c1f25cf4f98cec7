#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "daemon/tools/csv/csv_units.hpp"
#include "engine/wind/station_quantities.hpp"

namespace yuragi::daemon::tools::csv {

/// The meanings that a column of a CSV file can have.
enum class Role : std::uint8_t {
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
inline constexpr std::array<Role, 6> kQuantityRoles = {Role::kVerticalSpeed, Role::kTemperature, Role::kPressure,
                                                       Role::kHumidity,      Role::kRainTotal,   Role::kRainRate};
static_assert(kQuantityRoles.size() == wind::kStationQuantities.size());

std::string_view name_of(Role role);
Dimension dimension_of(Role role);

}  // namespace yuragi::daemon::tools::csv
