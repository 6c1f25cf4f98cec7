#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/simd_row.hpp"
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
  /// The tile lies turned by an angle of this cosine and sine, so that a noise that goes along x or z crosses it at a
  /// slant, and does not come back to where it was after a period.
  double turn_cos = 1.0;
  double turn_sin = 0.0;
  std::span<const float> x_m = {};  ///< the places' x for this layer; none: that of all layers
};

/// Several noises over the same places, each of which goes its own way: their sum changes as it goes, where a single
/// one would pass by as a picture. (A CarriedNoise goes one way, with the wind.) Mean 0, variance the sum of the
/// squared weights.
///
/// Allocates when it is made, never afterwards; throws the errors of make_noise_2d, and std::bad_alloc. Thread-safe:
/// sample() among themselves, yes. Realtime-safe: all but construction.
class LayeredNoise {
 public:
  /// Layers: 1 to SampleJob::kMaxLayers. Places: coordinates in metres, as many of x as of z.
  /// Where they are the rows of a grid, `columns` is how many stand in a row: if rows go along x, as in a scene that
  /// is not turned, they are read faster, by GridSampleJob, to the same bits. Such a grid has one to
  /// GridSampleJob::kMaxLayers layers, none of which is turned or has an x of its own, and does not lean.
  LayeredNoise(std::span<const NoiseLayerSpec> layers, std::span<const float> x_m, std::span<const float> z_m,
               std::size_t columns = 0);

  /// Shifting operator: a layer goes on by so much.
  void shift(std::size_t layer, double x_m, double z_m) noexcept;

  /// Moves the places from `first` on, `count` of them, to x_m east of where they were made.
  void lean(std::size_t first, std::size_t count, double x_m) noexcept;

  /// From now on the layer has this standard deviation in the sum: 0 to the one that it was made with.
  void set_weight(std::size_t layer, float weight) noexcept { layers_[layer].weight = weight; }

  /// The steepness of a layer as it is read, for a weight of 1: the root mean square of its slope, a metre.
  double slope_rms_per_m(std::size_t layer) const noexcept { return layers_[layer].slope_rms_per_m; }

  /// Sampling operator: the sum of the layers at each place, as many as `out` has.
  void sample(SimdRow row, std::span<float> out) const noexcept;

  /// No more than this does a layer, of its largest weight, change at a place when it is moved by so much against the
  /// place.
  double largest_change(std::size_t layer, double x_m, double z_m) const noexcept;

  /// Between these the sum is, whatever the weights.
  double lowest() const noexcept { return lowest_; }
  double highest() const noexcept { return highest_; }

 private:
  struct Layer {
    noise::Tile2 tile;
    double period_x_m;
    double period_z_m;
    float weight;
    noise::TorusOffset offset;
    std::vector<std::uint32_t> first_place_x, first_place_z;  ///< where the places were made
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
