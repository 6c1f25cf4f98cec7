#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "engine/base/time.hpp"

namespace yuragi::wind {

/// The other quantities of a weather station besides the horizontal wind, unchanged. nullopt: not reported. For the
/// recording alone: no estimate and no animation uses it.
struct StationQuantities {
  Instant time;                              ///< when it arrived
  std::optional<double> vertical_speed_m_s;  ///< upward positive
  std::optional<double> air_temperature_c;   ///< degrees Celsius
  std::optional<double> pressure_hpa;  ///< at the station or reduced to sea level, depending on the station's setting
  std::optional<double> relative_humidity_percent;
  std::optional<double> rain_total_mm;  ///< the station's own counter, which it can reset
  std::optional<double> rain_rate_mm_h;
};

/// One of the quantities: its name in recordings and CSV, and the closed interval of its values.
struct StationQuantity {
  std::string_view name;
  std::optional<double> StationQuantities::*value;
  double least;
  double greatest;
};

/// All of them. The ranges contain the World Meteorological Organization's records (Archive of Weather and Climate
/// Extremes: -89.2 to 56.7 degrees Celsius, 870 to 1084.8 hPa at sea level), with room for stations on mountains.
inline constexpr std::array<StationQuantity, 6> kStationQuantities = {{
    {"vertical_speed_m_s", &StationQuantities::vertical_speed_m_s, -50.0, 50.0},
    {"air_temperature_c", &StationQuantities::air_temperature_c, -100.0, 80.0},
    {"pressure_hpa", &StationQuantities::pressure_hpa, 300.0, 1100.0},
    {"relative_humidity_percent", &StationQuantities::relative_humidity_percent, 0.0, 100.0},
    {"rain_total_mm", &StationQuantities::rain_total_mm, 0.0, 100'000.0},
    {"rain_rate_mm_h", &StationQuantities::rain_rate_mm_h, 0.0, 3'000.0},
}};

/// The quantities that are finite and within their range; nullopt if there are none. Thread-safe and realtime-safe:
/// yes.
std::optional<StationQuantities> plausible_part(const StationQuantities& quantities) noexcept;

}  // namespace yuragi::wind
