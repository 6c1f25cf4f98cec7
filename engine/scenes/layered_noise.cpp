#include "engine/scenes/layered_noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/noise/band_limited_tile.hpp"
#include "engine/operators/grid_sample_job.hpp"
#include "engine/operators/sample_job.hpp"
#include "engine/scenes/grid_places.hpp"

namespace yuragi {
namespace {

std::vector<std::uint32_t> phases_on(std::span<const float> positions_m, double period_m) {
  std::vector<std::uint32_t> phases;
  phases.reserve(positions_m.size());
  for (const float position_m : positions_m) {
    phases.push_back(torus_phase(static_cast<double>(position_m), period_m));
  }
  return phases;
}

}  // namespace

LayeredNoise::LayeredNoise(std::span<const NoiseLayerSpec> layers, std::span<const float> x_m,
                           std::span<const float> z_m, std::size_t columns)
    : is_grid_(layers.size() <= GridSampleJob::kMaxLayers && goes_along_axes(x_m, z_m, columns)) {
  // Of a grid the first row has every x, and the first column every z.
  std::vector<float> column_z_m;
  if (is_grid_) {
    for (std::size_t i = 0; i < z_m.size(); i += columns) column_z_m.push_back(z_m[i]);
    x_m = x_m.first(columns);
    z_m = column_z_m;
  }
  for (const NoiseLayerSpec& spec : layers) {
    const auto place_x = phases_on(x_m, spec.period_x_m);
    layers_.push_back({.tile = BandLimitedTile2(make_noise_2d(spec.noise).value(), spec.band + 1).level(spec.band),
                       .period_x_m = spec.period_x_m,
                       .period_z_m = spec.period_z_m,
                       .weight = spec.weight,
                       .offset = {},
                       .first_place_x = place_x,
                       .place_x = place_x,
                       .place_z = phases_on(z_m, spec.period_z_m)});

    // A tile that is read bilinearly is nowhere steeper than between neighbours.
    Layer& layer = layers_.back();
    const NoiseTile2& tile = layer.tile;
    float steepest_x = 0.0F;
    float steepest_z = 0.0F;
    for (std::size_t z = 0; z < tile.size; ++z) {
      for (std::size_t x = 0; x < tile.size; ++x) {
        steepest_x = std::max(steepest_x, std::abs(tile.at((x + 1) % tile.size, z) - tile.at(x, z)));
        steepest_z = std::max(steepest_z, std::abs(tile.at(x, (z + 1) % tile.size) - tile.at(x, z)));
      }
    }
    const double weighted_size = static_cast<double>(spec.weight) * static_cast<double>(tile.size);
    layer.steepest_x_per_m = static_cast<double>(steepest_x) * weighted_size / spec.period_x_m;
    layer.steepest_z_per_m = static_cast<double>(steepest_z) * weighted_size / spec.period_z_m;

    const auto [low, high] = std::minmax_element(tile.values.begin(), tile.values.end());
    layer.range = static_cast<double>(spec.weight) * static_cast<double>(*high - *low);
    lowest_ += static_cast<double>(spec.weight) * static_cast<double>(*low);
    highest_ += static_cast<double>(spec.weight) * static_cast<double>(*high);
  }
}

void LayeredNoise::shift(std::size_t layer, double x_m, double z_m) noexcept {
  layers_[layer].offset.x.add(x_m, layers_[layer].period_x_m);
  layers_[layer].offset.z.add(z_m, layers_[layer].period_z_m);
}

void LayeredNoise::lean(std::size_t first, std::size_t count, double x_m) noexcept {
  for (Layer& layer : layers_) {
    const std::uint32_t way = torus_phase(x_m, layer.period_x_m);
    for (std::size_t i = first; i < first + count; ++i) layer.place_x[i] = layer.first_place_x[i] + way;
  }
}

void LayeredNoise::sample(SimdRow row, std::span<float> out) const noexcept {
  if (is_grid_) return sample_grid(row, out);
  std::array<NoiseLayer, SampleJob::kMaxLayers> read;
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    const Layer& layer = layers_[i];
    read[i] = {.tile = &layer.tile,
               .place_x = layer.place_x,
               .place_z = layer.place_z,
               .offset = layer.offset.phase(),
               .weight = layer.weight};
  }
  SampleJob{.layers = std::span(read).first(layers_.size()), .row = row, .out = out}.run();
}

void LayeredNoise::sample_grid(SimdRow row, std::span<float> out) const noexcept {
  std::array<GridNoiseLayer, GridSampleJob::kMaxLayers> read;
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    const Layer& layer = layers_[i];
    read[i] = {.tile = &layer.tile,
               .column_x = layer.place_x,
               .row_z = layer.place_z,
               .offset = layer.offset.phase(),
               .weight = layer.weight};
  }
  GridSampleJob{.layers = std::span(read).first(layers_.size()), .row = row, .out = out}.run();
}

double LayeredNoise::largest_change(std::size_t layer, double x_m, double z_m) const noexcept {
  const Layer& moved = layers_[layer];
  return std::min(moved.steepest_x_per_m * std::abs(x_m) + moved.steepest_z_per_m * std::abs(z_m), moved.range);
}

}  // namespace yuragi
