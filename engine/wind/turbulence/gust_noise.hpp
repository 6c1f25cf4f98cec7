#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/state_pass.hpp"
#include "engine/noise/noise_tile.hpp"
#include "engine/noise/torus.hpp"
#include "engine/noise/torus_read.hpp"
#include "engine/noise/vector_noise.hpp"
#include "engine/wind/wind_vector.hpp"

namespace yuragi::wind::turbulence {

/// GustNoise::Moment::fronts that gives the noise the skewness of turbulence (engine/wind/model.md W42).
inline constexpr float kFronts = 0.14F;

/// Parameters of the noise of gusts.
struct GustNoiseSettings {
  double period_m = 256.0;    ///< of the first chain's middle tile
  std::size_t samples = 512;  ///< an edge of the largest tiles: a power of two, 128 to 2048
  std::uint64_t seed = 1;
  /// Eddies turn over while they travel, so that a gust does not return unchanged when its tile repeats. Needs twice
  /// the memory, and twice as many samples to read.
  bool evolves = false;
};

/// Gusts as a pattern that the wind carries over the ground, split into octaves of the wavenumber, so that each can be
/// given its own strength at each moment (engine/wind/model.md W14). Every octave has mean 0 and variance 1 as it is
/// read, in every direction.
///
/// The octaves of the tiles are vectors, as on a plane through isotropic, incompressible turbulence
/// (noise::VectorNoise2): gusts have the width of W13 across the wind, in every direction. The scalar part and the curl
/// are mixed as in the inertial range: longer waves than the integral scale should have less curl, which changes no
/// spectrum along or across the wind by more than 0.5 dB.
///
/// Two chains of octaves are added, the second's waves longer than the first's by the golden section, so that no repeat
/// is visible. A chain's waves of 2048 m down to 0.25 m are 2-D noises on three tori, each turned by a different angle:
/// four octaves on a long tile (2048 m), six on a middle one (256 m, with waves of 128 m and less: a tile has too few
/// waves of its own length for an even spectrum), three on a short one (32 m). Longer waves are the same everywhere in
/// the scene: a 1-D noise along the wind's path (65 km and 106 km before it repeats). An octave's shortest wave has
/// four samples or more.
///
/// If it evolves, an octave of a tile is two tiles mixed, cos(a) of one and sin(a) of the other (VectorNoise2), and its
/// angle a advances by w = turnover |k|^(2/3) a second, |k| in the octave's middle: an eddy's own rate (Kolmogorov
/// 1941), turnover being the cube root of the dissipation, eddy_turnover_m23_s().
///
/// Gusts come in fronts: with a moment's `fronts` f above 0, an octave of the middle and short tiles is stronger where
/// the longer ones of them rise as the wind carries them, weaker where they fall, by (1 + f d) / sqrt(1 + f^2) (W42). d
/// has variance 1: it is -d(along)/d(ahead) of those octaves at the moment's strengths, over its deviation.
///
/// Gusts come in bursts: with a moment's gustiness above 0, all octaves of the tiles are stronger together in some
/// places and weaker in others, by envelope() (W16). It travels with them.
///
/// Owns its tiles (13 MB at 512 samples, 26 MB if it evolves). Set-up work. Thread-safe: reading, yes. Realtime-safe:
/// all but construction.
class GustNoise {
 public:
  /// Octaves of each chain: of the way, and of its tiles, of which the first are the long tile's and the last the short
  /// one's.
  static constexpr std::size_t kWayOctaves = 5;
  static constexpr std::size_t kTileOctaves = 13;
  static constexpr std::size_t kLongOctaves = 4;
  static constexpr std::size_t kShortOctaves = 3;
  /// Of both chains: the first's way, the second's way, the first's tiles, the second's; the longest waves first.
  static constexpr std::size_t kFirstTileOctave = 2 * kWayOctaves;
  static constexpr std::size_t kOctaves = 2 * (kWayOctaves + kTileOctaves);

  /// Throws the errors of make_noise_2d, and std::bad_alloc.
  explicit GustNoise(const GustNoiseSettings& settings);

  /// What it was made of.
  const GustNoiseSettings& settings() const noexcept { return settings_; }

  /// An octave: its waves, and its own part of the power at its wavenumbers (the two chains share it).
  struct Octave {
    double from_rad_m = 0.0;
    double to_rad_m = 0.0;
    double share = 1.0;
  };
  const std::array<Octave, kOctaves>& octaves() const noexcept { return octaves_; }

  /// How far apart the samples of an octave's tiles are, m; octaves of the tiles are counted from the first chain's
  /// longest. A wave is read linearly between them.
  double sample_m(std::size_t tile_octave) const noexcept {
    return tori_[torus_of(tile_octave)].period_m / static_cast<double>(tiles_[tile_octave].first.x.size);
  }

  /// How far the eddies of each octave of the tiles, the first chain's and the second's, have turned.
  struct EddyPhases {
    std::array<noise::TorusTravel, 2 * kTileOctaves> turns;
    std::array<float, 2 * kTileOctaves> cosine, sine;
    EddyPhases() noexcept {
      cosine.fill(1.0F);
      sine.fill(0.0F);
    }
    void list_state(StatePass& pass) { pass(turns, cosine, sine); }
  };

  /// The tiles' tori: the first chain's long, middle and short one, then the second's.
  static constexpr std::size_t kTori = 6;
  /// The torus of an octave of the tiles, counted from the first chain's longest.
  static constexpr std::size_t torus_of(std::size_t tile_octave) noexcept {
    const std::size_t octave = tile_octave % kTileOctaves;
    const std::size_t first = tile_octave < kTileOctaves ? 0 : kTori / 2;
    return first + (octave < kLongOctaves ? 0 : octave < kTileOctaves - kShortOctaves ? 1 : 2);
  }

  /// How far the pattern has been carried, and its eddies have turned.
  struct Carried {
    std::array<noise::TorusOffset, kTori> tiles;
    noise::TorusTravel way_first, way_second;
    EddyPhases eddies;
    void list_state(StatePass& pass) { pass(tiles, way_first, way_second, eddies); }
  };
  /// A start position, far from that of another seed.
  Carried begin(std::uint64_t seed) const noexcept;

  /// The wind (east and south, m/s) carries the pattern on for dt_s; meanwhile its eddies turn over, if it evolves, at
  /// a rate of `turnover_m23_s` |k|^(2/3) rad/s (|k| in rad/m; 0: frozen).
  void carry(Carried& carried, double east_m_s, double south_m_s, double dt_s,
             double turnover_m23_s = 0.0) const noexcept;

  /// The octaves' values, linear between samples, at a place (metres east and south of the middle of the scene), each
  /// of variance 1: along the unit vector `ahead` and to the left of it.
  struct Values {
    std::array<float, kOctaves> along, across;
  };
  Values at(const Carried& carried, double east_m, double south_m, Vector ahead = {0.0, 1.0}) const noexcept;

  /// The pattern at a moment: its displacement, the direction of its `along`, and the strength of each octave (its
  /// standard deviation).
  struct Moment {
    Carried carried;
    Vector ahead{0.0, 1.0};  ///< unit vector downwind; `across` is to the left of it
    std::array<float, kOctaves> along_m_s{}, across_m_s{};
    float gustiness = 0.0F;  ///< variation of the gusts' strength from place to place, by envelope(); 0: uniform
    float fronts = 0.0F;     ///< increase of gusts where longer ones rise, and decrease where they fall; 0: none

    /// All but gustiness and fronts, which never change.
    void list_state(StatePass& pass) {
      pass(carried, along_m_s, across_m_s);
      pass.unit_vector(ahead.u_m_s, ahead.v_m_s);
    }
  };
  /// The gusts that are the same at all places: the octaves of the way.
  Vector everywhere(const Moment& moment) const noexcept;
  /// The gusts of a place alone: the octaves of the tiles (metres east and south of the middle of the scene).
  Vector local(const Moment& moment, double east_m, double south_m) const noexcept;

  /// The strength of the gusts at a place relative to the usual: exp(g G - g^2), g being the moment's gustiness and G a
  /// noise of variance 1 with waves of 100 to 400 m (at periods of 256 m). Its mean square is 1. Exactly 1 where g is
  /// 0. Gusts whose strength varies in this way have the sharp increments of real ones (Castaing, Gagne and Hopfinger
  /// 1990, Velocity probability density functions of high Reynolds number turbulence: a lognormal strength).
  float envelope(const Moment& moment, double east_m, double south_m) const noexcept;

  /// The gusts of a place as layers, for reading at many places at once and adding up in their order, without the
  /// envelope: see operators::VectorLayer for most members. A place is read at place_on(torus_of(layer.octave), ...)
  /// - offset.
  struct Layer {
    const noise::VectorTile2* tile = nullptr;
    const noise::VectorTile2* quarter = nullptr;  ///< null: nothing evolves
    float cosine = 1.0F, sine = 0.0F;
    std::size_t octave = 0;  ///< of the tiles, counted from the first chain's longest
    noise::TorusPhase offset;
    float ahead_x = 0.0F, ahead_z = 0.0F;  ///< direction of the wind, on the tile's axes
    float along_m_s = 0.0F, across_m_s = 0.0F;
    float strength = 1.0F, strength_per_fall_s = 0.0F, samples_per_m = 0.0F;
  };
  static constexpr std::size_t kMaxLayers = 2 * kTileOctaves;

  /// Writes those that have a weight; how many they are.
  std::size_t layers(const Moment& moment, std::span<Layer, kMaxLayers> out) const noexcept;

  /// A place on a torus.
  noise::TorusPhase place_on(std::size_t torus, double east_m, double south_m) const noexcept;

 private:
  /// A tile's torus on the ground.
  struct Torus {
    double period_m = 0.0;
    double cosine = 1.0, sine = 0.0;  ///< of the angle of its turn
    /// East and south, m, along its axes.
    std::array<double, 2> turned(double east_m, double south_m) const noexcept {
      return {cosine * east_m + sine * south_m, cosine * south_m - sine * east_m};
    }
  };
  using Ways = std::array<noise::Tile1, 2 * kWayOctaves>;
  using Tiles = std::array<noise::VectorNoise2, 2 * kTileOctaves>;

  static noise::VectorReading read(const Layer& layer, noise::TorusPhase place) noexcept;

  static Ways make_ways(std::uint64_t seed);
  static Tiles make_tiles(const GustNoiseSettings& settings);
  /// A unit vector on the axes of each torus.
  std::array<std::array<float, 2>, kTori> on_axes(Vector unit) const noexcept;

  GustNoiseSettings settings_;
  std::array<double, 2> way_periods_m_;
  std::array<Torus, kTori> tori_;
  std::array<Octave, kOctaves> octaves_{};
  std::array<double, 2 * kTileOctaves> turn_rates_m_23_{};     ///< |k|^(2/3) in the middle of each octave of the tiles
  std::array<float, 2 * kTileOctaves> slope_variances_m_2_{};  ///< of the change of an octave's component along itself
  Ways ways_along_, ways_across_;                              ///< of both chains
  Tiles tiles_;
  noise::Tile2 strength_;  ///< the envelope's G, on the first torus
};

/// How fast eddies turn over in a wind of standard deviation `sigma_m_s` (along it) and integral length scale
/// `length_m` (above 0): the cube root of its dissipation, 0.88 sigma / L^(1/3), in m^(2/3)/s; an eddy of wavenumber k
/// turns its phase by this times k^(2/3) rad/s. 0.88 is what makes the inertial range of von Karman's spectrum,
/// 0.39 sigma^2 L^(-2/3) k^(-5/3), Kolmogorov's, 0.5 epsilon^(2/3) k^(-5/3) (Kaimal and Finnigan 1994, Atmospheric
/// Boundary Layer Flows, 2.5). Thread-safe and realtime-safe: yes.
double eddy_turnover_m23_s(double sigma_m_s, double length_m) noexcept;

}  // namespace yuragi::wind::turbulence
