#include "engine/operators/sample_job.hpp"

#include <bit>
#include <cmath>

#include "engine/base/kernel.hpp"
#include "engine/operators/operator_kernels.hpp"

namespace yuragi {
namespace {

constexpr KernelRows<SampleKernels> kSampleRows = YURAGI_KERNEL_ROWS(sample_kernels);

}  // namespace

SampleJob::Problem SampleJob::validate() const noexcept {
  if (tile == nullptr || !is_readable(*tile)) return Problem::kTileNotReadable;
  if (place_x.size() != out.size() || place_z.size() != out.size()) return Problem::kSizesDiffer;
  if (!std::isfinite(scale) || !std::isfinite(bias) || !(low <= high)) return Problem::kRangeNotNumber;
  if (row && !is_runnable(*row)) return Problem::kRowNotRunnable;
  return Problem::kNone;
}

SampleJob::Problem SampleJob::run() const noexcept {
  const Problem problem = validate();
  if (problem != Problem::kNone) return problem;
  kSampleRows[row.value_or(best_simd_row())].sample({.count = out.size(),
                                                     .tile = tile->values.data(),
                                                     .log2_size = static_cast<unsigned>(std::countr_zero(tile->size)),
                                                     .place_x = place_x.data(),
                                                     .place_z = place_z.data(),
                                                     .offset_x = offset.x,
                                                     .offset_z = offset.z,
                                                     .scale = scale,
                                                     .bias = bias,
                                                     .low = low,
                                                     .high = high,
                                                     .out = out.data()});
  return Problem::kNone;
}

}  // namespace yuragi
