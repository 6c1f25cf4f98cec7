#include "engine/operators/displacement_job.hpp"

#include <cmath>

#include "engine/base/kernel.hpp"
#include "engine/operators/surface_kernels.hpp"

namespace yuragi::operators {
namespace {

constexpr KernelRows<SurfaceKernels> kDisplacementRows = YURAGI_KERNEL_ROWS(surface_kernels);

}  // namespace

DisplacementJob::Problem DisplacementJob::validate() const noexcept {
  if (!std::isfinite(amplitude_m)) return Problem::kAmplitudeNotNumber;
  if (share.size() != noise.size() || displacement_m.size() != noise.size()) return Problem::kSizesDiffer;
  if (row && !is_runnable(*row)) return Problem::kRowNotRunnable;
  return Problem::kNone;
}

DisplacementJob::Problem DisplacementJob::run() const noexcept {
  const Problem problem = validate();
  if (problem != Problem::kNone) return problem;
  kDisplacementRows[row.value_or(best_simd_row())].displace({.count = noise.size(),
                                                             .noise = noise.data(),
                                                             .share = share.data(),
                                                             .amplitude_m = static_cast<float>(amplitude_m),
                                                             .out = displacement_m.data()});
  return Problem::kNone;
}

}  // namespace yuragi::operators
