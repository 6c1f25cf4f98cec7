#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "engine/base/simd_row.hpp"
#include "engine/base/state_pass.hpp"
#include "engine/noise/band_limited_tile.hpp"
#include "engine/noise/spectral_noise.hpp"
#include "engine/noise/torus.hpp"

namespace yuragi::scenes {

/// Parameters of a carried noise.
struct CarriedNoiseSpec {
  double period_m = 256.0;    ///< of the first tile, above 0
  std::size_t samples = 512;  ///< an edge of each tile: a power of two
  double beta = 5.0 / 3.0;
  noise::BetaMeaning meaning = noise::BetaMeaning::kTransect;
  bool has_two_tiles = true;  ///< false: one tile, as in the paper
  /// Limits to waves of these lengths, at least an octave apart, metres; 0 and infinity: all waves of the tile. A band
  /// has variance 1 as it is read, and is not cut by the tick rate: keep its shortest waves above twice the distance
  /// per tick.
  double shortest_m = 0.0;
  double longest_m = std::numeric_limits<double>::infinity();
  std::uint64_t seed = 0;
};

/// The steepest slope of a tile of `period_m` read bilinearly, in any direction, a metre.
double steepest_slope(const noise::Tile2& tile, double period_m) noexcept;

/// The positions of many things on each tile of a CarriedNoise: phases, one element per thing.
struct CarriedPlaces {
  std::vector<std::uint32_t> first_x, first_z;
  std::vector<std::uint32_t> second_x, second_z;

  std::size_t size() const { return first_x.size(); }
};

/// A 2-D noise that the wind carries along: the shifting and sampling operators (ShiftJob, SampleJob) as most scenes
/// use them. Mean 0, variance 1.
///
/// Two tiles are added (engine/METHOD.md D7): the second is turned by one radian and its period is that of the first
/// times the golden ratio, so that the sum has no period and no visible repeat. Both have the same spectrum in rad/m,
/// and both are carried by the same wind. Both are band-limited by the tick rate (BandLimitedTile2, D16): in a storm
/// waves that are too fine fade out, and nothing jitters from tick to tick. Allocates when it is made and in places(),
/// never afterwards. May throw std::bad_alloc, and the errors of make_noise_2d. Thread-safe: sample() among themselves,
/// yes. Realtime-safe: shift() and sample().
class CarriedNoise {
 public:
  explicit CarriedNoise(const CarriedNoiseSpec& spec);

  /// The positions of things with these coordinates on the ground (or on a cloth, along and across it), metres.
  CarriedPlaces places(std::span<const float> x_m, std::span<const float> z_m) const;

  /// The wind (toward +x and +z, m/s) carries the noise on for dt_s (above 0); a tick later it is sampled again.
  void shift(double toward_x_m_s, double toward_z_m_s, double dt_s) noexcept;

  /// out = clamp(bias + scale * noise, low, high) for as many places as `out` has elements, from place `first` on;
  /// `places` are of this noise.
  void sample(const CarriedPlaces& places, SimdRow row, std::span<float> out, float scale = 1.0F, float bias = 0.0F,
              float low = -std::numeric_limits<float>::infinity(), float high = std::numeric_limits<float>::infinity(),
              std::size_t first = 0) const noexcept;

  /// The maximum change of the noise at a place in a tick of dt_s while the wind is at most speed_m_s and changes by at
  /// most step_m_s: by the tiles' steepest slopes over the distance, and for a change of the band limit the maximum
  /// difference of two levels; at most the noise's whole range.
  double largest_change(double speed_m_s, double step_m_s, double dt_s) const noexcept;

  /// The spec of a band of waves for things that flutter (engine/METHOD.md D10): 1/f along a line, in tiles of eight of
  /// the longest waves with 4.5 samples or more to the shortest. One tile takes half the time, and is enough if it is
  /// about as large as the thing that reads it: it is turned by an angle whose tangent is the golden section, so that
  /// waves that run east or south for hours repeat as late as possible.
  static CarriedNoiseSpec band(double shortest_m, double longest_m, std::uint64_t seed, bool has_two_tiles = true);

  /// Between these its values are.
  double lowest() const noexcept { return lowest_; }
  double highest() const noexcept { return highest_; }

  void list_state(StatePass& pass) {
    for (Tile& tile : tiles_) pass(tile.offset);
  }

 private:
  struct Tile {
    noise::BandLimitedTile2 noise;
    double period_m = 1.0;
    noise::TorusOffset offset = {};
    noise::BandPick band = {};
    std::vector<double> steepest_per_m = {};  ///< of each level
    double largest_octave = 0.0;              ///< maximum difference of two neighbouring levels
  };

  static Tile make_tile(const CarriedNoiseSpec& spec, std::uint64_t which, double period_m);

  std::vector<Tile> tiles_;     ///< one or two
  double turn_cos_, turn_sin_;  ///< the turn of the first tile
  float weight_;
  double lowest_ = 0.0, highest_ = 0.0;
};

}  // namespace yuragi::scenes
