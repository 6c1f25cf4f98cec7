#include "engine/operators/grid_sample_job.hpp"

#include <bit>
#include <cmath>

#include "engine/base/kernel.hpp"
#include "engine/operators/grid_sample_kernels.hpp"

namespace yuragi::operators {
namespace {

constexpr KernelRows<GridSampleKernels> kGridSampleRows = YURAGI_KERNEL_ROWS(grid_sample_kernels);

}  // namespace

GridSampleJob::Problem GridSampleJob::validate() const noexcept {
  if (layers.empty() || layers.size() > kMaxLayers) return Problem::kLayerCount;
  const std::size_t columns = layers[0].column_x.size();
  const std::size_t rows = layers[0].row_z.size();
  if (out.size() != columns * rows) return Problem::kSizesDiffer;
  for (const GridNoiseLayer& layer : layers) {
    if (layer.tile == nullptr || !noise::is_readable(*layer.tile)) return Problem::kTileNotReadable;
    if (layer.column_x.size() != columns || layer.row_z.size() != rows) return Problem::kSizesDiffer;
    if (!std::isfinite(layer.weight)) return Problem::kWeightNotNumber;
  }
  if (row && !is_runnable(*row)) return Problem::kRowNotRunnable;
  return Problem::kNone;
}

GridSampleJob::Problem GridSampleJob::run() const noexcept {
  const Problem problem = validate();
  if (problem != Problem::kNone) return problem;

  GridSampleKernelArguments arguments{
      .columns = layers[0].column_x.size(), .rows = layers[0].row_z.size(), .out = out.data()};
  for (const GridNoiseLayer& layer : layers) {
    arguments.layers[arguments.layer_count++] = {.tile = layer.tile->values.data(),
                                                 .log2_size = static_cast<unsigned>(std::countr_zero(layer.tile->size)),
                                                 .column_x = layer.column_x.data(),
                                                 .row_z = layer.row_z.data(),
                                                 .offset_x = layer.offset.x,
                                                 .offset_z = layer.offset.z,
                                                 .weight = layer.weight};
  }
  kGridSampleRows[row.value_or(best_simd_row())].sample(arguments);
  return Problem::kNone;
}

}  // namespace yuragi::operators
