#include "engine/operators/color_map_job.hpp"

#include "engine/base/kernel.hpp"
#include "engine/operators/surface_kernels.hpp"

namespace yuragi::operators {
namespace {

constexpr KernelRows<SurfaceKernels> kColorMapRows = YURAGI_KERNEL_ROWS(surface_kernels);

}  // namespace

ColorMapJob::Problem ColorMapJob::validate() const noexcept {
  if (ramp_rgba.size() != 4 * kRampColors) return Problem::kRampSize;
  if (rgba.size() != 4 * level.size()) return Problem::kSizesDiffer;
  if (row && !is_runnable(*row)) return Problem::kRowNotRunnable;
  return Problem::kNone;
}

ColorMapJob::Problem ColorMapJob::run() const noexcept {
  const Problem problem = validate();
  if (problem != Problem::kNone) return problem;
  kColorMapRows[row.value_or(best_simd_row())].map_colors(
      {.count = level.size(), .level = level.data(), .ramp_rgba = ramp_rgba.data(), .out = rgba.data()});
  return Problem::kNone;
}

}  // namespace yuragi::operators
