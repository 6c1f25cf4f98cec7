#pragma once

#include <optional>

#include "drivers/windlog/sqlite.hpp"
#include "engine/base/time.hpp"
#include "engine/wind/wind_reading.hpp"

namespace yuragi::drivers::windlog {

/// Returns the reading of that time in the current row of `statement`, whose columns from `speed` on are speed,
/// direction, gust and quality; nullopt if they cannot be a reading.
inline std::optional<wind::Reading> reading_of_columns(const sqlite::Statement& statement, int speed,
                                                       const Instant& time) {
  const int direction = speed + 1;
  const int gust = speed + 2;
  const int quality = speed + 3;
  const auto is_number = [&statement](int column) {
    return statement.type(column) == SQLITE_FLOAT || statement.type(column) == SQLITE_INTEGER;
  };
  if (!is_number(speed) || statement.type(quality) != SQLITE_INTEGER) return std::nullopt;
  for (const int column : {direction, gust}) {
    if (!is_number(column) && statement.type(column) != SQLITE_NULL) return std::nullopt;
  }
  const std::int64_t grade = statement.integer(quality);
  if (grade < 0 || grade > static_cast<std::int64_t>(wind::ReadingQuality::kSimulated)) return std::nullopt;

  wind::Reading reading;
  reading.time = time;
  reading.speed_m_s = statement.number(speed);
  if (is_number(direction)) reading.direction_deg = statement.number(direction);
  if (is_number(gust)) reading.gust_m_s = statement.number(gust);
  reading.quality = static_cast<wind::ReadingQuality>(grade);
  if (!wind::is_plausible(reading)) return std::nullopt;
  return reading;
}

}  // namespace yuragi::drivers::windlog
