#include "engine/operators/branch_force_job.hpp"

#include <algorithm>

#include "engine/base/kernel.hpp"
#include "engine/operators/crown_kernels.hpp"
#include "engine/operators/streamlined_drag.hpp"

namespace yuragi::operators {
namespace {

constexpr KernelRows<CrownKernels> kForceRows = YURAGI_KERNEL_ROWS(crown_kernels);

bool is_speed(double speed_m_s, double least_m_s) {
  return speed_m_s >= least_m_s && speed_m_s <= 1e6;
}

}  // namespace

BranchForceJob::Problem BranchForceJob::validate() const noexcept {
  if (!is_speed(mean_m_s, 0.0)) return Problem::kMean;
  if (!is_speed(streamline_speed_m_s, 0.01)) return Problem::kStreamlineSpeed;
  if (!is_speed(calm_m_s, 0.01)) return Problem::kCalmSpeed;
  const std::size_t count = noise.size();
  for (const std::size_t size :
       {wind_east_m_s.size(), wind_south_m_s.size(), toward_east.size(), toward_south.size()}) {
    if (size != count) return Problem::kSizesDiffer;
  }
  if (row && !is_runnable(*row)) return Problem::kRowNotRunnable;
  return Problem::kNone;
}

float BranchForceJob::mean_force() const noexcept {
  const auto speed = static_cast<float>(std::max(mean_m_s, calm_m_s) / streamline_speed_m_s);
  return streamlined_drag(speed * speed);
}

BranchForceJob::Problem BranchForceJob::run() const noexcept {
  const Problem problem = validate();
  if (problem != Problem::kNone) return problem;
  kForceRows[row.value_or(best_simd_row())].force(
      {.count = noise.size(),
       .wind_east_m_s = wind_east_m_s.data(),
       .wind_south_m_s = wind_south_m_s.data(),
       .per_streamline_speed = static_cast<float>(1.0 / streamline_speed_m_s),
       .per_mean_force = 1.0F / mean_force(),
       .calm_square = static_cast<float>(calm_m_s * calm_m_s),
       .noise = noise.data(),
       .toward_east = toward_east.data(),
       .toward_south = toward_south.data()});
  return Problem::kNone;
}

}  // namespace yuragi::operators
