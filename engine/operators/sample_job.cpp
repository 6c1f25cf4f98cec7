#include "engine/operators/sample_job.hpp"

#include <bit>
#include <cmath>

#include "engine/base/kernel.hpp"
#include "engine/operators/operator_kernels.hpp"

namespace yuragi::operators {
namespace {

constexpr KernelRows<SampleKernels> kSampleRows = YURAGI_KERNEL_ROWS(sample_kernels);

}  // namespace

SampleJob::Problem SampleJob::validate() const noexcept {
  if (layers.empty() || layers.size() > kMaxLayers) return Problem::kLayerCount;
  for (const NoiseLayer& layer : layers) {
    if (layer.tile == nullptr || !noise::is_readable(*layer.tile)) return Problem::kTileNotReadable;
    if (layer.place_x.size() != out.size() || layer.place_z.size() != out.size()) return Problem::kSizesDiffer;
    if (!layer.weights.empty() && layer.weights.size() != out.size()) return Problem::kSizesDiffer;
    if (!std::isfinite(layer.weight)) return Problem::kRangeNotNumber;
  }
  if (!std::isfinite(scale) || !std::isfinite(bias) || !(low <= high)) return Problem::kRangeNotNumber;
  if (row && !is_runnable(*row)) return Problem::kRowNotRunnable;
  return Problem::kNone;
}

SampleJob::Problem SampleJob::run() const noexcept {
  const Problem problem = validate();
  if (problem != Problem::kNone) return problem;

  SampleKernelArguments arguments{
      .count = out.size(), .scale = scale, .bias = bias, .low = low, .high = high, .out = out.data()};
  for (const NoiseLayer& layer : layers) {
    arguments.layers[arguments.layer_count++] = {.tile = layer.tile->values.data(),
                                                 .log2_size = static_cast<unsigned>(std::countr_zero(layer.tile->size)),
                                                 .place_x = layer.place_x.data(),
                                                 .place_z = layer.place_z.data(),
                                                 .offset_x = layer.offset.x,
                                                 .offset_z = layer.offset.z,
                                                 .weight = layer.weight,
                                                 .weights = layer.weights.empty() ? nullptr : layer.weights.data()};
  }
  kSampleRows[row.value_or(best_simd_row())].sample(arguments);
  return Problem::kNone;
}

}  // namespace yuragi::operators
