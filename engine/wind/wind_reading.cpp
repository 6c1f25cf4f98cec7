#include "engine/wind/wind_reading.hpp"

#include <cmath>

namespace yuragi::wind {
namespace {

bool is_physical_speed(double speed_m_s) {
  return std::isfinite(speed_m_s) && speed_m_s >= 0.0 && speed_m_s <= kMaxPlausibleSpeed_m_s;
}

}  // namespace

bool is_plausible(const Reading& reading) noexcept {
  if (!is_physical_speed(reading.speed_m_s)) return false;
  if (reading.gust_m_s && !is_physical_speed(*reading.gust_m_s)) return false;
  if (!reading.direction_deg) return true;
  return std::isfinite(*reading.direction_deg) && *reading.direction_deg >= 0.0 && *reading.direction_deg < 360.0;
}

bool has_same_values(const Reading& a, const Reading& b) noexcept {
  return a.speed_m_s == b.speed_m_s && a.direction_deg == b.direction_deg && a.gust_m_s == b.gust_m_s;
}

}  // namespace yuragi::wind
