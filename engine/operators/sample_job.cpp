#include "engine/operators/sample_job.hpp"

#include <bit>
#include <cmath>

#include "engine/base/kernel.hpp"
#include "engine/operators/operator_kernels.hpp"

namespace yuragi::operators {
namespace {

constexpr KernelRows<SampleKernels> kSampleRows = YURAGI_KERNEL_ROWS(sample_kernels);

bool is_readable(const noise::VectorTile2& tile) noexcept {
  return noise::is_readable(tile.x) && noise::is_readable(tile.z) && tile.x.size == tile.z.size;
}

bool is_readable(const VectorLayer& layer) noexcept {
  if (layer.tile == nullptr || !is_readable(*layer.tile)) return false;
  return layer.quarter == nullptr || (is_readable(*layer.quarter) && layer.quarter->x.size == layer.tile->x.size);
}

/// `size`: of an edge of the layer's tile.
template <class Layer>
SampleKernelPlaces places_of(const Layer& layer, std::size_t size) noexcept {
  return {.log2_size = static_cast<unsigned>(std::countr_zero(size)),
          .x = layer.place_x.data(),
          .z = layer.place_z.data(),
          .offset_x = layer.offset.x,
          .offset_z = layer.offset.z};
}

const float* data_or_null(std::span<const float> weights) noexcept {
  return weights.empty() ? nullptr : weights.data();
}

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
                                                 .places = places_of(layer, layer.tile->size),
                                                 .weight = layer.weight,
                                                 .weights = data_or_null(layer.weights)};
  }
  kSampleRows[row.value_or(best_simd_row())].sample(arguments);
  return Problem::kNone;
}

VectorSampleJob::Problem VectorSampleJob::validate() const noexcept {
  if (layers.size() > kMaxLayers) return Problem::kLayerCount;
  if (out_across.size() != out_along.size()) return Problem::kSizesDiffer;
  const auto has_size = [this](const auto& values) { return values.size() == out_along.size(); };
  for (const VectorLayer& layer : layers) {
    if (!is_readable(layer)) return Problem::kTileNotReadable;
    if (!has_size(layer.place_x) || !has_size(layer.place_z)) return Problem::kSizesDiffer;
    if (!layer.along_weights.empty() && !has_size(layer.along_weights)) return Problem::kSizesDiffer;
    if (!layer.across_weights.empty() && !has_size(layer.across_weights)) return Problem::kSizesDiffer;
    for (const float number : {layer.cosine, layer.sine, layer.ahead_x, layer.ahead_z, layer.along, layer.across,
                               layer.strength, layer.strength_per_fall_s, layer.samples_per_m}) {
      if (!std::isfinite(number)) return Problem::kWeightNotFinite;
    }
  }
  if (row && !is_runnable(*row)) return Problem::kRowNotRunnable;
  return Problem::kNone;
}

VectorSampleJob::Problem VectorSampleJob::run() const noexcept {
  const Problem problem = validate();
  if (problem != Problem::kNone) return problem;

  VectorSampleKernelArguments arguments{
      .count = out_along.size(), .out_along = out_along.data(), .out_across = out_across.data()};
  for (const VectorLayer& layer : layers) {
    const bool turns = layer.quarter != nullptr;
    arguments.layers[arguments.layer_count++] = {.tile_x = layer.tile->x.values.data(),
                                                 .tile_z = layer.tile->z.values.data(),
                                                 .quarter_x = turns ? layer.quarter->x.values.data() : nullptr,
                                                 .quarter_z = turns ? layer.quarter->z.values.data() : nullptr,
                                                 .cosine = layer.cosine,
                                                 .sine = layer.sine,
                                                 .places = places_of(layer, layer.tile->x.size),
                                                 .ahead_x = layer.ahead_x,
                                                 .ahead_z = layer.ahead_z,
                                                 .along = layer.along,
                                                 .across = layer.across,
                                                 .along_weights = data_or_null(layer.along_weights),
                                                 .across_weights = data_or_null(layer.across_weights),
                                                 .strength = layer.strength,
                                                 .strength_per_fall = layer.strength_per_fall_s,
                                                 .samples_per_m = layer.samples_per_m};
  }
  kSampleRows[row.value_or(best_simd_row())].sample_vectors(arguments);
  return Problem::kNone;
}

}  // namespace yuragi::operators
