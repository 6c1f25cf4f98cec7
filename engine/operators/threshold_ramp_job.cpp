#include "engine/operators/threshold_ramp_job.hpp"

#include <cmath>

#include "engine/base/kernel.hpp"
#include "engine/operators/surface_kernels.hpp"

namespace yuragi::operators {
namespace {

constexpr KernelRows<SurfaceKernels> kThresholdRampRows = YURAGI_KERNEL_ROWS(surface_kernels);

}  // namespace

ThresholdRampJob::Problem ThresholdRampJob::validate() const noexcept {
  if (along.size() != noise.size() || level.size() != noise.size()) return Problem::kSizesDiffer;
  if (!std::isfinite(last_threshold - first_threshold)) return Problem::kThresholdNotNumber;
  if (!std::isfinite(edge) || !std::isfinite(1.0F / edge) || !(edge > 0.0F)) return Problem::kEdge;
  if (row && !is_runnable(*row)) return Problem::kRowNotRunnable;
  return Problem::kNone;
}

ThresholdRampJob::Problem ThresholdRampJob::run() const noexcept {
  const Problem problem = validate();
  if (problem != Problem::kNone) return problem;
  kThresholdRampRows[row.value_or(best_simd_row())].threshold_ramp({.count = noise.size(),
                                                                    .noise = noise.data(),
                                                                    .along = along.data(),
                                                                    .first_threshold = first_threshold,
                                                                    .rise = last_threshold - first_threshold,
                                                                    .per_edge = 1.0F / edge,
                                                                    .out = level.data()});
  return Problem::kNone;
}

}  // namespace yuragi::operators
