#include "daemon/tools/csv/csv_role.hpp"

namespace yuragi::daemon::tools::csv {

std::string_view name_of(CsvRole role) {
  static constexpr std::array<std::string_view, kCsvRoleCount> kNames = {
      "time",    "date",   "elapsed", "speed",       "direction", "gust",     "u",          "v",
      "quality", "sensor", "w",       "temperature", "pressure",  "humidity", "rain total", "rain rate"};
  return kNames.at(static_cast<std::size_t>(role));
}

CsvDimension dimension_of(CsvRole role) {
  switch (role) {
    case CsvRole::kSpeed:
    case CsvRole::kGust:
    case CsvRole::kU:
    case CsvRole::kV:
    case CsvRole::kVerticalSpeed:
      return CsvDimension::kSpeed;
    case CsvRole::kDirection:
      return CsvDimension::kDirection;
    case CsvRole::kTime:
    case CsvRole::kElapsed:
      return CsvDimension::kTime;
    case CsvRole::kTemperature:
      return CsvDimension::kTemperature;
    case CsvRole::kPressure:
      return CsvDimension::kPressure;
    case CsvRole::kHumidity:
      return CsvDimension::kHumidity;
    case CsvRole::kRainTotal:
      return CsvDimension::kRain;
    case CsvRole::kRainRate:
      return CsvDimension::kRainRate;
    case CsvRole::kDate:
    case CsvRole::kQuality:
    case CsvRole::kSensor:
      break;
  }
  return CsvDimension::kNone;
}

}  // namespace yuragi::daemon::tools::csv
