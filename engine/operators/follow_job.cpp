#include "engine/operators/follow_job.hpp"

#include <algorithm>
#include <cmath>

#include "engine/base/kernel.hpp"
#include "engine/operators/cloth_kernels.hpp"

namespace yuragi {
namespace {

constexpr KernelRows<ClothKernels> kFollowRows = YURAGI_KERNEL_ROWS(cloth_kernels);

/// Of value and rate: below it nothing is seen to move, and the rest of the way would be in numbers that processors are
/// slow with.
constexpr float kAtRest = 1e-9F;

/// In w dt: nothing is left of any distance.
constexpr double kLongAgo = 80.0;

}  // namespace

FollowJob::Problem FollowJob::validate() const noexcept {
  if (!std::isfinite(omega_rad_s) || !(omega_rad_s > 0.0)) return Problem::kOmega;
  if (!std::isfinite(dt_s) || !(dt_s > 0.0)) return Problem::kStepNotPositive;
  if (value.size() != target.size() || rate_per_s.size() != target.size()) return Problem::kSizesDiffer;
  if (row && !is_runnable(*row)) return Problem::kRowNotRunnable;
  return Problem::kNone;
}

FollowJob::Problem FollowJob::run() const noexcept {
  const Problem problem = validate();
  if (problem != Problem::kNone) return problem;

  // With d = q - target: d(t) = (d + (q' + w d) t) exp(-w t), and its derivative.
  const double phase = std::min(omega_rad_s * dt_s, kLongAgo);
  const double step_s = phase / omega_rad_s;
  const double decay = std::exp(-phase);
  kFollowRows[row.value_or(best_simd_row())].follow(
      {.count = target.size(),
       .target = target.data(),
       .distance_kept = static_cast<float>(decay * (1.0 + phase)),
       .distance_from_rate_s = static_cast<float>(decay * step_s),
       .rate_kept = static_cast<float>(decay * (1.0 - phase)),
       .rate_from_distance_per_s = static_cast<float>(decay * omega_rad_s * phase),
       .at_rest = kAtRest,
       .value = value.data(),
       .rate_per_s = rate_per_s.data()});
  return Problem::kNone;
}

}  // namespace yuragi
