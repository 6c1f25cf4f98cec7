#include "engine/operators/shift_job.hpp"

#include <cmath>

namespace yuragi::operators {

ShiftJob::Problem ShiftJob::validate() const noexcept {
  if (offset == nullptr) return Problem::kNoOffset;
  if (!std::isfinite(wind_east_m_s) || !std::isfinite(wind_south_m_s)) return Problem::kWindNotFinite;
  if (!std::isfinite(dt_s) || !(dt_s > 0.0)) return Problem::kStepNotPositive;
  if (!std::isfinite(period_m) || !(period_m > 0.0)) return Problem::kPeriodNotPositive;
  return Problem::kNone;
}

ShiftJob::Problem ShiftJob::run() const noexcept {
  const Problem problem = validate();
  if (problem != Problem::kNone) return problem;
  offset->x.add(wind_east_m_s * dt_s, period_m);
  offset->z.add(wind_south_m_s * dt_s, period_m);
  return Problem::kNone;
}

}  // namespace yuragi::operators
