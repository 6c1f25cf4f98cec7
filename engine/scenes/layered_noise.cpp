#include "engine/scenes/layered_noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/noise/band_limited_tile.hpp"
#include "engine/operators/grid_sample_job.hpp"
#include "engine/operators/sample_job.hpp"
#include "engine/scenes/grid_places.hpp"

namespace yuragi::scenes {
namespace {

/// One coordinate of places on a turned tile: from_x x + from_z z, as phases. Either can be omitted if its factor is 0.
std::vector<std::uint32_t> phases_on(std::span<const float> x_m, double from_x, std::span<const float> z_m,
                                     double from_z, double period_m) {
  std::vector<std::uint32_t> phases;
  const std::size_t count = from_x != 0.0 ? x_m.size() : z_m.size();
  phases.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double along_x_m = from_x != 0.0 ? from_x * static_cast<double>(x_m[i]) : 0.0;
    const double along_z_m = from_z != 0.0 ? from_z * static_cast<double>(z_m[i]) : 0.0;
    phases.push_back(noise::torus_phase(along_x_m + along_z_m, period_m));
  }
  return phases;
}

bool is_plain(const NoiseLayerSpec& layer) {
  return layer.turn_cos == 1.0 && layer.turn_sin == 0.0 && layer.x_m.empty();
}

}  // namespace

LayeredNoise::LayeredNoise(std::span<const NoiseLayerSpec> layers, std::span<const float> x_m,
                           std::span<const float> z_m, std::size_t columns)
    : is_grid_(layers.size() <= operators::GridSampleJob::kMaxLayers &&
               std::all_of(layers.begin(), layers.end(), is_plain) && goes_along_axes(x_m, z_m, columns)) {
  // In a grid the first row has every x, and the first column every z.
  std::vector<float> column_z_m;
  if (is_grid_) {
    for (std::size_t i = 0; i < z_m.size(); i += columns) column_z_m.push_back(z_m[i]);
    x_m = x_m.first(columns);
    z_m = column_z_m;
  }
  for (const NoiseLayerSpec& spec : layers) {
    const std::span<const float> own_x_m = spec.x_m.empty() ? x_m : spec.x_m;
    const auto place_x = phases_on(own_x_m, spec.turn_cos, z_m, -spec.turn_sin, spec.period_x_m);
    const auto place_z = phases_on(own_x_m, spec.turn_sin, z_m, spec.turn_cos, spec.period_z_m);
    layers_.push_back(
        {.tile = noise::BandLimitedTile2(noise::make_noise_2d(spec.noise).value(), spec.band + 1).level(spec.band),
         .period_x_m = spec.period_x_m,
         .period_z_m = spec.period_z_m,
         .weight = spec.weight,
         .offset = {},
         .first_place_x = place_x,
         .first_place_z = place_z,
         .place_x = place_x,
         .place_z = place_z,
         .turn_cos = spec.turn_cos,
         .turn_sin = spec.turn_sin});

    // A tile that is interpolated bilinearly has its steepest slope between neighbours.
    Layer& layer = layers_.back();
    const noise::Tile2& tile = layer.tile;
    float steepest_x = 0.0F;
    float steepest_z = 0.0F;
    double squares = 0.0;
    const double cells_per_x_m = static_cast<double>(tile.size) / spec.period_x_m;
    const double cells_per_z_m = static_cast<double>(tile.size) / spec.period_z_m;
    for (std::size_t z = 0; z < tile.size; ++z) {
      for (std::size_t x = 0; x < tile.size; ++x) {
        const float along_x = tile.at((x + 1) % tile.size, z) - tile.at(x, z);
        const float along_z = tile.at(x, (z + 1) % tile.size) - tile.at(x, z);
        steepest_x = std::max(steepest_x, std::abs(along_x));
        steepest_z = std::max(steepest_z, std::abs(along_z));
        const double slope_x_per_m = cells_per_x_m * static_cast<double>(along_x);
        const double slope_z_per_m = cells_per_z_m * static_cast<double>(along_z);
        squares += slope_x_per_m * slope_x_per_m + slope_z_per_m * slope_z_per_m;
      }
    }
    layer.steepest_x_per_m = static_cast<double>(spec.weight) * static_cast<double>(steepest_x) * cells_per_x_m;
    layer.steepest_z_per_m = static_cast<double>(spec.weight) * static_cast<double>(steepest_z) * cells_per_z_m;
    layer.slope_rms_per_m = std::sqrt(squares / static_cast<double>(tile.values.size()));

    const auto [low, high] = std::minmax_element(tile.values.begin(), tile.values.end());
    layer.range = static_cast<double>(spec.weight) * static_cast<double>(*high - *low);
    lowest_ += static_cast<double>(spec.weight) * static_cast<double>(*low);
    highest_ += static_cast<double>(spec.weight) * static_cast<double>(*high);
  }
}

void LayeredNoise::shift(std::size_t layer, double x_m, double z_m) noexcept {
  Layer& moved = layers_[layer];
  moved.offset.x.add(moved.turn_cos * x_m - moved.turn_sin * z_m, moved.period_x_m);
  moved.offset.z.add(moved.turn_sin * x_m + moved.turn_cos * z_m, moved.period_z_m);
}

void LayeredNoise::lean(std::size_t first, std::size_t count, double x_m) noexcept {
  for (Layer& layer : layers_) {
    const std::uint32_t way_x = noise::torus_phase(layer.turn_cos * x_m, layer.period_x_m);
    const std::uint32_t way_z = noise::torus_phase(layer.turn_sin * x_m, layer.period_z_m);
    for (std::size_t i = first; i < first + count; ++i) {
      layer.place_x[i] = layer.first_place_x[i] + way_x;
      layer.place_z[i] = layer.first_place_z[i] + way_z;
    }
  }
}

void LayeredNoise::sample(SimdRow row, std::span<float> out) const noexcept {
  if (is_grid_) return sample_grid(row, out);
  std::array<operators::NoiseLayer, operators::SampleJob::kMaxLayers> read;
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    const Layer& layer = layers_[i];
    read[i] = {.tile = &layer.tile,
               .place_x = layer.place_x,
               .place_z = layer.place_z,
               .offset = layer.offset.phase(),
               .weight = layer.weight};
  }
  operators::SampleJob{.layers = std::span(read).first(layers_.size()), .row = row, .out = out}.run();
}

void LayeredNoise::sample_grid(SimdRow row, std::span<float> out) const noexcept {
  std::array<operators::GridNoiseLayer, operators::GridSampleJob::kMaxLayers> read;
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    const Layer& layer = layers_[i];
    read[i] = {.tile = &layer.tile,
               .column_x = layer.place_x,
               .row_z = layer.place_z,
               .offset = layer.offset.phase(),
               .weight = layer.weight};
  }
  operators::GridSampleJob{.layers = std::span(read).first(layers_.size()), .row = row, .out = out}.run();
}

double LayeredNoise::largest_change(std::size_t layer, double x_m, double z_m) const noexcept {
  const Layer& moved = layers_[layer];
  const double turned_x_m = std::abs(moved.turn_cos * x_m - moved.turn_sin * z_m);
  const double turned_z_m = std::abs(moved.turn_sin * x_m + moved.turn_cos * z_m);
  return std::min(moved.steepest_x_per_m * turned_x_m + moved.steepest_z_per_m * turned_z_m, moved.range);
}

}  // namespace yuragi::scenes
