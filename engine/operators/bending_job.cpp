#include "engine/operators/bending_job.hpp"

#include <algorithm>
#include <cmath>

#include "engine/base/kernel.hpp"
#include "engine/base/units.hpp"
#include "engine/operators/operator_kernels.hpp"

namespace yuragi::operators {
namespace {

constexpr KernelRows<BendingKernels> kBendingRows = YURAGI_KERNEL_ROWS(bending_kernels);
constexpr double kMinHalfBendSpeed_m_s = 0.01;
constexpr double kStrongestWind = 1e9;  ///< in half-bend speeds: a stronger wind has no further effect

}  // namespace

BendingJob::Problem BendingJob::validate() const noexcept {
  if (!std::isfinite(wind_east_m_s * wind_east_m_s + wind_south_m_s * wind_south_m_s)) return Problem::kWindNotFinite;
  if (!std::isfinite(half_bend_speed_m_s) || half_bend_speed_m_s < kMinHalfBendSpeed_m_s) {
    return Problem::kHalfBendSpeed;
  }
  if (!(max_bend_rad >= 0.0 && max_bend_rad <= kPi)) return Problem::kMaxBend;
  const std::size_t count = strength.size();
  if (flexibility.size() != count || bend_east_rad.size() != count || bend_south_rad.size() != count) {
    return Problem::kSizesDiffer;
  }
  if (row && !is_runnable(*row)) return Problem::kRowNotRunnable;
  return Problem::kNone;
}

BendingJob::Problem BendingJob::run() const noexcept {
  const Problem problem = validate();
  if (problem != Problem::kNone) return problem;

  // Speed and direction of the wind; calm air has no direction, and needs none.
  const double speed_m_s = std::sqrt(wind_east_m_s * wind_east_m_s + wind_south_m_s * wind_south_m_s);
  const double per_speed = speed_m_s > 0.0 ? max_bend_rad / speed_m_s : 0.0;
  kBendingRows[row.value_or(best_simd_row())].bend(
      {.count = strength.size(),
       .strength = strength.data(),
       .flexibility = flexibility.data(),
       .wind_in_half_bends = static_cast<float>(std::min(speed_m_s / half_bend_speed_m_s, kStrongestWind)),
       .bend_east_rad = static_cast<float>(wind_east_m_s * per_speed),
       .bend_south_rad = static_cast<float>(wind_south_m_s * per_speed),
       .out_east_rad = bend_east_rad.data(),
       .out_south_rad = bend_south_rad.data()});
  return Problem::kNone;
}

}  // namespace yuragi::operators
