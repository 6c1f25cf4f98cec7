#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/noise/noise_tile.hpp"
#include "engine/noise/torus.hpp"
#include "engine/wind/wind_vector.hpp"

namespace yuragi {

/// What the noise of gusts is like.
struct GustNoiseSettings {
  double period_m = 256.0;    ///< of the first tile
  std::size_t samples = 512;  ///< an edge of each tile: a power of two, 64 to 2048
  std::uint64_t seed = 1;
  /// Eddies turn over while they travel, so that a gust does not come back unchanged when its tile has wrapped. Twice
  /// the memory, and two tiles to read where a frozen octave has one.
  bool evolves = false;
};

/// Gusts as a pattern that the wind carries over the ground, taken apart into octaves of the wavenumber, so that each
/// can be given the strength that the moment asks for. Every octave has mean 0 and variance 1.
///
/// What fits on a tile is a 2-D noise: two tiles are added whose periods have the ratio of the golden section, the
/// second turned by one radian, so that no repeat is seen. Waves of four samples are the shortest. What is longer than
/// a tile is the same everywhere in the scene: a 1-D noise along the way that the wind has come (65 km and 106 km
/// before it repeats).
///
/// Where it evolves, an octave of a tile is two tiles mixed, cos(a) of one and sin(a) of the other (TurningNoise2), and
/// its angle a goes on by w = turnover |k|^(2/3) a second, |k| in the octave's middle: an eddy's own rate (Kolmogorov
/// 1941), turnover being the cube root of the dissipation, eddy_turnover_m23_s().
///
/// Owns its tiles (about 30 MB at 512 samples, 60 MB if it evolves). Set-up work. Thread-safe: reading, yes.
/// Realtime-safe: all but construction.
class GustNoise {
 public:
  /// Octaves below the tiles (of the way), and those of each tile.
  static constexpr std::size_t kWayOctaves = 8;
  static constexpr std::size_t kTileOctaves = 7;
  static constexpr std::size_t kFirstTileOctave = 2 * kWayOctaves;
  static constexpr std::size_t kOctaves = 2 * (kWayOctaves + kTileOctaves);

  /// Throws what make_noise_2d says, and std::bad_alloc.
  explicit GustNoise(const GustNoiseSettings& settings);

  /// An octave: its waves, and which part of the power at its wavenumbers is its own (the two tiles share).
  struct Octave {
    double from_rad_m = 0.0;
    double to_rad_m = 0.0;
    double share = 1.0;
  };
  const std::array<Octave, kOctaves>& octaves() const noexcept { return octaves_; }

  /// How far the eddies of each octave of the tiles, first and second, have turned.
  struct Turned {
    std::array<TorusTravel, 2 * kTileOctaves> turns;
    std::array<float, 2 * kTileOctaves> cosine, sine;
    Turned() noexcept {
      cosine.fill(1.0F);
      sine.fill(0.0F);
    }
  };

  /// How far the pattern has been carried, and its eddies have turned.
  struct Carried {
    TorusOffset first, second;
    TorusTravel way_first, way_second;
    Turned turned;
  };
  /// A place to begin at; far from that of another seed.
  Carried begin(std::uint64_t seed) const noexcept;

  /// The wind (east and south, m/s) carries the pattern on for dt_s; meanwhile its eddies turn over, if it evolves, at
  /// a rate of `turnover_m23_s` |k|^(2/3) rad/s (|k| in rad/m; 0: frozen).
  void carry(Carried& carried, double east_m_s, double south_m_s, double dt_s,
             double turnover_m23_s = 0.0) const noexcept;

  /// The octaves' values, linear between samples, at a place (metres east and south of the middle of the scene), each
  /// of variance 1: along the wind and across it.
  struct Values {
    std::array<float, kOctaves> along, across;
  };
  Values at(const Carried& carried, double east_m, double south_m) const noexcept;

  /// The pattern at a moment: how far it has been carried, which way its `along` points, and how strong each octave is
  /// (its standard deviation).
  struct Moment {
    Carried carried;
    WindVector ahead{0.0, 1.0};  ///< unit vector downwind; `across` is to the left of it
    std::array<float, kOctaves> along_m_s{}, across_m_s{};
  };
  /// The gusts that all places have alike: the octaves of the way.
  WindVector everywhere(const Moment& moment) const noexcept;
  /// The gusts of a place alone: the octaves of the tiles (metres east and south of the middle of the scene).
  WindVector local(const Moment& moment, double east_m, double south_m) const noexcept;

  /// The same as layers, to be read at many places at once and added up: a tile, how far it has been carried, and its
  /// weight in m/s. A place is read at place_on(layer.which, ...) - offset. An octave that evolves has two layers.
  struct Layer {
    const NoiseTile2* tile = nullptr;
    std::size_t which = 0;  ///< on the first tile's torus, or on the second's
    TorusPhase offset;
    float weight_m_s = 0.0F;
  };
  enum class Component : std::uint8_t { kAlong, kAcross };
  static constexpr std::size_t kMaxLayers = 4 * kTileOctaves;  ///< half as many if nothing evolves

  /// Writes those that have a weight; how many they are.
  std::size_t layers(const Moment& moment, Component component, std::span<Layer, kMaxLayers> out) const noexcept;

  /// A place on the torus of a tile.
  TorusPhase place_on(std::size_t which, double east_m, double south_m) const noexcept;

 private:
  /// One component of the wind: the octaves of both tiles and of both ways.
  struct Octaves {
    std::array<std::vector<NoiseTile2>, 2> tiles;
    std::array<std::vector<NoiseTile2>, 2> quarters;  ///< the same, a quarter turn on; none if nothing evolves
    std::array<std::vector<NoiseTile1>, 2> ways;
  };

  static Octaves make_octaves(const GustNoiseSettings& settings, std::uint64_t seed);
  static float read_tile(const Octaves& component, std::size_t which, std::size_t octave, TorusPhase place,
                         const Turned& turned) noexcept;
  std::array<float, kOctaves> read(const Octaves& component, TorusPhase first, TorusPhase second,
                                   const Carried& carried) const noexcept;

  std::array<double, 2> periods_m_;  ///< of the tiles
  std::array<Octave, kOctaves> octaves_{};
  bool evolves_;
  Octaves along_, across_;
};

/// How fast eddies turn over in a wind of standard deviation `sigma_m_s` (along it) and integral length scale
/// `length_m` (above 0): the cube root of its dissipation, 0.88 sigma / L^(1/3), in m^(2/3)/s; an eddy of wavenumber k
/// turns its phase by this times k^(2/3) rad/s. 0.88 is what makes the inertial range of von Karman's spectrum,
/// 0.39 sigma^2 L^(-2/3) k^(-5/3), Kolmogorov's, 0.5 epsilon^(2/3) k^(-5/3) (Kaimal and Finnigan 1994, Atmospheric
/// Boundary Layer Flows, 2.5). Thread-safe and realtime-safe: yes.
double eddy_turnover_m23_s(double sigma_m_s, double length_m) noexcept;

}  // namespace yuragi
