#include "engine/operators/wind_side_job.hpp"

#include <cmath>

namespace yuragi::operators {
namespace {

/// How widely, in radii, the bend at the floor is rounded.
constexpr float kFloorRounding = 0.1F;

}  // namespace

WindSideJob::Problem WindSideJob::validate() const noexcept {
  if (!std::isfinite(wind_east_m_s * wind_east_m_s + wind_south_m_s * wind_south_m_s)) return Problem::kWindNotFinite;
  if (!(calm_m_s > 0.0 && calm_m_s * calm_m_s > 0.0 && std::isfinite(calm_m_s * calm_m_s))) return Problem::kCalmSpeed;
  if (!(floor > 0.0) || !std::isfinite(floor)) return Problem::kFloor;
  if (place_x.size() != distance.size() || place_z.size() != distance.size()) return Problem::kSizesDiffer;
  return Problem::kNone;
}

WindSideJob::Problem WindSideJob::run() const noexcept {
  const Problem problem = validate();
  if (problem != Problem::kNone) return problem;
  const double length_m_s =
      std::sqrt(wind_east_m_s * wind_east_m_s + wind_south_m_s * wind_south_m_s + calm_m_s * calm_m_s);
  const auto east = static_cast<float>(wind_east_m_s / length_m_s);
  const auto south = static_cast<float>(wind_south_m_s / length_m_s);
  const auto lowest = static_cast<float>(floor);
  for (std::size_t i = 0; i < distance.size(); ++i) {
    const float above = 1.0F + (place_x[i] * east + place_z[i] * south) - lowest;
    distance[i] = lowest + 0.5F * (above + std::sqrt(above * above + kFloorRounding * kFloorRounding));
  }
  return Problem::kNone;
}

}  // namespace yuragi::operators
