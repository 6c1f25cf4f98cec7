#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "engine/base/simd_row.hpp"
#include "engine/noise/noise_tile.hpp"
#include "engine/noise/spectral_noise.hpp"
#include "engine/noise/torus.hpp"

namespace yuragi {

/// What a carried noise is like.
struct CarriedNoiseSpec {
  double period_m = 256.0;    ///< of the first tile, above 0
  std::size_t samples = 512;  ///< an edge of each tile: a power of two
  double beta = 5.0 / 3.0;
  BetaMeaning meaning = BetaMeaning::kTransect;
  bool has_two_tiles = true;  ///< false: one tile, the paper's letter
  std::uint64_t seed = 0;
};

/// Where many things stand, on each tile of a CarriedNoise: phases, one element a thing.
struct CarriedPlaces {
  std::vector<std::uint32_t> first_x, first_z;
  std::vector<std::uint32_t> second_x, second_z;

  std::size_t size() const { return first_x.size(); }
};

/// A 2-D noise that the wind carries along: the shifting and sampling operators (ShiftJob, SampleJob) as most scenes
/// use them. Mean 0, variance 1.
///
/// Two tiles are added: the second is turned by one radian and its period is that of the first over the golden ratio,
/// so that the sum has no period and no repeat is seen (method, decision 7). Both have the same spectrum in rad/m, and
/// both are carried by the same wind. Allocates when it is made and in places(), never afterwards. May throw
/// std::bad_alloc, and what make_noise_2d says.
/// Thread-safe: sample() among themselves, yes. Realtime-safe: shift() and sample().
class CarriedNoise {
 public:
  explicit CarriedNoise(const CarriedNoiseSpec& spec);

  /// Where things stand whose coordinates on the ground (or on a cloth, along and across it) are these, metres.
  CarriedPlaces places(std::span<const float> x_m, std::span<const float> z_m) const;

  /// The wind (toward +x and +z, m/s) carries the noise on for dt_s (above 0).
  void shift(double toward_x_m_s, double toward_z_m_s, double dt_s) noexcept;

  /// out = clamp(bias + scale * noise, low, high) at each place; `places` are of this noise and as many as `out`.
  void sample(const CarriedPlaces& places, SimdRow row, std::span<float> out, float scale = 1.0F, float bias = 0.0F,
              float low = -std::numeric_limits<float>::infinity(),
              float high = std::numeric_limits<float>::infinity()) const noexcept;

  /// No more than this does the noise change at a place while it is carried on by distance_m: from the tiles' own
  /// steepest slope, and never more than from their lowest value to their highest.
  double largest_change(double distance_m) const noexcept;

  /// Between these its values are.
  double lowest() const noexcept { return lowest_; }
  double highest() const noexcept { return highest_; }

 private:
  struct Tile {
    NoiseTile2 noise;
    double period_m = 1.0;
    TorusOffset offset;
  };

  std::size_t tile_count() const noexcept { return has_two_tiles_ ? 2 : 1; }

  bool has_two_tiles_;
  float weight_;
  Tile first_, second_;
  double steepest_per_m_ = 0.0;
  double lowest_ = 0.0, highest_ = 0.0;
};

}  // namespace yuragi
