#include "daemon/tools/csv/csv_role.hpp"

namespace yuragi::daemon::tools::csv {

std::string_view name_of(Role role) {
  static constexpr std::array<std::string_view, kCsvRoleCount> kNames = {
      "time",    "date",   "elapsed", "speed",       "direction", "gust",     "u",          "v",
      "quality", "sensor", "w",       "temperature", "pressure",  "humidity", "rain total", "rain rate"};
  return kNames.at(static_cast<std::size_t>(role));
}

Dimension dimension_of(Role role) {
  switch (role) {
    case Role::kSpeed:
    case Role::kGust:
    case Role::kU:
    case Role::kV:
    case Role::kVerticalSpeed:
      return Dimension::kSpeed;
    case Role::kDirection:
      return Dimension::kDirection;
    case Role::kTime:
    case Role::kElapsed:
      return Dimension::kTime;
    case Role::kTemperature:
      return Dimension::kTemperature;
    case Role::kPressure:
      return Dimension::kPressure;
    case Role::kHumidity:
      return Dimension::kHumidity;
    case Role::kRainTotal:
      return Dimension::kRain;
    case Role::kRainRate:
      return Dimension::kRainRate;
    case Role::kDate:
    case Role::kQuality:
    case Role::kSensor:
      break;
  }
  return Dimension::kNone;
}

}  // namespace yuragi::daemon::tools::csv
