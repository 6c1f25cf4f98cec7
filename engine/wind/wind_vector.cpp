#include "engine/wind/wind_vector.hpp"

#include <cmath>

#include "engine/base/units.hpp"
#include "engine/math/portable.hpp"

namespace yuragi::wind {

double speed_of(Vector wind) noexcept {
  return math::length(wind.u_m_s, wind.v_m_s);
}

double direction_from_deg(Vector wind) noexcept {
  if (wind.u_m_s == 0.0 && wind.v_m_s == 0.0) return 0.0;
  const double direction_deg = std::atan2(-wind.u_m_s, -wind.v_m_s) / kRadPerDeg;
  const double positive_deg = direction_deg < 0.0 ? direction_deg + 360.0 : direction_deg;
  return positive_deg >= 360.0 ? 0.0 : positive_deg;
}

Vector wind_from(double speed_m_s, double direction_deg) noexcept {
  const double from_rad = direction_deg * kRadPerDeg;
  return {-speed_m_s * std::sin(from_rad), -speed_m_s * std::cos(from_rad)};
}

}  // namespace yuragi::wind
