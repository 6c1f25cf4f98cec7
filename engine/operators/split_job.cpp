#include "engine/operators/split_job.hpp"

#include <cmath>

#include "engine/base/kernel.hpp"
#include "engine/operators/crown_kernels.hpp"

namespace yuragi::operators {
namespace {

constexpr KernelRows<CrownKernels> kSplitRows = YURAGI_KERNEL_ROWS(crown_kernels);

}  // namespace

SplitJob::Problem SplitJob::validate() const noexcept {
  if (!std::isfinite(threshold) || !std::isfinite(threshold_rise)) return Problem::kThresholdNotFinite;
  if (!(width >= 1e-6 && width <= 1e6)) return Problem::kWidth;
  const std::size_t count = noise.size();
  if (ramp.size() != count || above.size() != count || below.size() != count) return Problem::kSizesDiffer;
  if (row && !is_runnable(*row)) return Problem::kRowNotRunnable;
  return Problem::kNone;
}

SplitJob::Problem SplitJob::run() const noexcept {
  const Problem problem = validate();
  if (problem != Problem::kNone) return problem;
  kSplitRows[row.value_or(best_simd_row())].split({.count = noise.size(),
                                                   .noise = noise.data(),
                                                   .ramp = ramp.data(),
                                                   .threshold = static_cast<float>(threshold),
                                                   .threshold_rise = static_cast<float>(threshold_rise),
                                                   .width = static_cast<float>(width),
                                                   .above = above.data(),
                                                   .below = below.data()});
  return Problem::kNone;
}

}  // namespace yuragi::operators
