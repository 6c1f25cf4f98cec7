#include "engine/operators/local_bending_job.hpp"

#include <cmath>

#include "engine/base/kernel.hpp"
#include "engine/base/units.hpp"
#include "engine/operators/operator_kernels.hpp"

namespace yuragi::operators {
namespace {

constexpr KernelRows<BendingKernels> kLocalBendingRows = YURAGI_KERNEL_ROWS(bending_kernels);
constexpr double kMinSpeed_m_s = 0.01;

}  // namespace

LocalBendingJob::Problem LocalBendingJob::validate() const noexcept {
  if (!std::isfinite(half_bend_speed_m_s) || half_bend_speed_m_s < kMinSpeed_m_s) return Problem::kHalfBendSpeed;
  if (!(max_bend_rad >= 0.0 && max_bend_rad <= kPi)) return Problem::kMaxBend;
  const std::size_t count = flexibility.size();
  if (wind_east_m_s.size() != count || wind_south_m_s.size() != count || strength.size() != count ||
      bend_east_rad.size() != count || bend_south_rad.size() != count) {
    return Problem::kSizesDiffer;
  }
  if (row && !is_runnable(*row)) return Problem::kRowNotRunnable;
  return Problem::kNone;
}

LocalBendingJob::Problem LocalBendingJob::run() const noexcept {
  const Problem problem = validate();
  if (problem != Problem::kNone) return problem;
  kLocalBendingRows[row.value_or(best_simd_row())].bend_locally(
      {.count = flexibility.size(),
       .wind_east_m_s = wind_east_m_s.data(),
       .wind_south_m_s = wind_south_m_s.data(),
       .strength = strength.data(),
       .flexibility = flexibility.data(),
       .half_bends_per_m_s = static_cast<float>(1.0 / half_bend_speed_m_s),
       .max_bend_rad = static_cast<float>(max_bend_rad),
       .out_east_rad = bend_east_rad.data(),
       .out_south_rad = bend_south_rad.data()});
  return Problem::kNone;
}

}  // namespace yuragi::operators
