#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/simd_row.hpp"
#include "engine/base/state_pass.hpp"
#include "engine/noise/noise_tile.hpp"
#include "engine/noise/spectral_noise.hpp"
#include "engine/noise/torus.hpp"

namespace yuragi::scenes {

/// One layer of a LayeredNoise.
struct NoiseLayerSpec {
  noise::Spec noise;
  double period_x_m = 1.0;  ///< of the tile along x, above 0
  double period_z_m = 1.0;  ///< along z: a tile may be stretched
  float weight = 1.0F;      ///< above 0: its standard deviation in the sum, at most (set_weight)
  std::size_t band = 0;     ///< the level of BandLimitedTile2 that is read: how many octaves of the finest are left out
  /// Cosine and sine of the tile's turn: a noise that moves along x or z then crosses it at a slant, and does not
  /// repeat after a period.
  double turn_cos = 1.0;
  double turn_sin = 0.0;
  std::span<const float> x_m = {};  ///< the places' x for this layer; empty: that of all layers
};

/// Several noises over the same places, each of which moves separately: their sum changes as it moves, while a single
/// one would pass as a fixed picture. (A CarriedNoise moves in one way, with the wind.) Mean 0, variance the sum of the
/// squared weights.
///
/// Allocates when it is made, never afterwards; throws the errors of make_noise_2d, and std::bad_alloc. Thread-safe:
/// sample() among themselves, yes. Realtime-safe: all but construction.
class LayeredNoise {
 public:
  /// Layers: 1 to SampleJob::kMaxLayers. Places: coordinates in metres, as many of x as of z.
  /// If they are the rows of a grid, `columns` is the number in a row: if rows go along x, as in a scene that is not
  /// turned, they are read faster, by GridSampleJob, to the same bits. Such a grid has one to GridSampleJob::kMaxLayers
  /// layers, none of which is turned or has an x of its own, and does not lean.
  LayeredNoise(std::span<const NoiseLayerSpec> layers, std::span<const float> x_m, std::span<const float> z_m,
               std::size_t columns = 0);

  /// Shifting operator: moves a layer by this distance.
  void shift(std::size_t layer, double x_m, double z_m) noexcept;

  /// Moves `count` places from `first` on to x_m east of their original positions.
  void lean(std::size_t first, std::size_t count, double x_m) noexcept;

  /// Sets the layer's standard deviation in the sum: 0 up to its initial one.
  void set_weight(std::size_t layer, float weight) noexcept { layers_[layer].weight = weight; }

  /// The root mean square of a layer's slope as it is read, for a weight of 1, per metre.
  double slope_rms_per_m(std::size_t layer) const noexcept { return layers_[layer].slope_rms_per_m; }

  /// Sampling operator: the sum of the layers at each place; `out` sets the number.
  void sample(SimdRow row, std::span<float> out) const noexcept;

  /// The maximum change of a layer, of its largest weight, at a place when it is moved by this distance relative to the
  /// place.
  double largest_change(std::size_t layer, double x_m, double z_m) const noexcept;

  /// Bounds of the sum, for all weights.
  double lowest() const noexcept { return lowest_; }
  double highest() const noexcept { return highest_; }

  void list_state(StatePass& pass) {
    for (Layer& layer : layers_) pass(layer.offset);
  }

 private:
  struct Layer {
    noise::Tile2 tile;
    double period_x_m;
    double period_z_m;
    float weight;
    noise::TorusOffset offset;
    std::vector<std::uint32_t> first_place_x, first_place_z;  ///< original positions
    std::vector<std::uint32_t> place_x, place_z;              ///< one a place; of a grid one a column, and one a row
    double turn_cos, turn_sin;
    double steepest_x_per_m = 0.0, steepest_z_per_m = 0.0;  ///< of the largest weight
    double slope_rms_per_m = 0.0;
    double range = 0.0;  ///< from the lowest value to the highest
  };

  void sample_grid(SimdRow row, std::span<float> out) const noexcept;

  bool is_grid_;
  std::vector<Layer> layers_;
  double lowest_ = 0.0, highest_ = 0.0;
};

}  // namespace yuragi::scenes
