#include "engine/operators/coat_bending_job.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/base/kernel.hpp"
#include "engine/base/units.hpp"
#include "engine/operators/operator_kernels.hpp"

namespace yuragi::operators {
namespace {

constexpr KernelRows<BendingKernels> kCoatRows = YURAGI_KERNEL_ROWS(bending_kernels);
constexpr double kSlowestHalfBend_m_s = 0.01;

bool is_bend(double angle_rad) {
  return angle_rad >= 0.0 && angle_rad <= kPi;
}

}  // namespace

CoatBendingJob::Problem CoatBendingJob::validate() const noexcept {
  if (!std::isfinite(wind_east_m_s * wind_east_m_s + wind_south_m_s * wind_south_m_s)) return Problem::kWindNotFinite;
  if (!std::isfinite(half_bend_speed_m_s) || half_bend_speed_m_s < kSlowestHalfBend_m_s) {
    return Problem::kHalfBendSpeed;
  }
  if (!is_bend(max_bend_rad) || !is_bend(stroke_rad)) return Problem::kBend;
  if (!(sheltered >= 0.0 && sheltered <= 1.0)) return Problem::kSheltered;
  const std::array sizes = {normal_x.size(),      normal_z.size(),      stroke_along.size(),
                            stroke_across.size(), bend_east_rad.size(), bend_south_rad.size()};
  if (!std::ranges::all_of(sizes, [this](std::size_t size) { return size == flexibility.size(); })) {
    return Problem::kSizesDiffer;
  }
  if (row && !is_runnable(*row)) return Problem::kRowNotRunnable;
  return Problem::kNone;
}

CoatBendingJob::Problem CoatBendingJob::run() const noexcept {
  const Problem problem = validate();
  if (problem != Problem::kNone) return problem;
  const double speed_m_s = std::sqrt(wind_east_m_s * wind_east_m_s + wind_south_m_s * wind_south_m_s);
  kCoatRows[row.value_or(best_simd_row())].bend_coat(
      {.count = flexibility.size(),
       .wind_east_m_s = static_cast<float>(wind_east_m_s),
       .wind_south_m_s = static_cast<float>(wind_south_m_s),
       .per_speed_s_m = speed_m_s > 0.0 ? static_cast<float>(1.0 / speed_m_s) : 0.0F,
       .normal_x = normal_x.data(),
       .normal_z = normal_z.data(),
       .stroke_along = stroke_along.data(),
       .stroke_across = stroke_across.data(),
       .flexibility = flexibility.data(),
       .half_bends_per_m_s = static_cast<float>(1.0 / half_bend_speed_m_s),
       .max_bend_rad = static_cast<float>(max_bend_rad),
       .stroke_rad = static_cast<float>(stroke_rad),
       .sheltered = static_cast<float>(sheltered),
       .out_east_rad = bend_east_rad.data(),
       .out_south_rad = bend_south_rad.data()});
  return Problem::kNone;
}

}  // namespace yuragi::operators
