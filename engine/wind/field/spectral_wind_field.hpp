#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/noise/moving_noise.hpp"
#include "engine/noise/noise_tile.hpp"
#include "engine/wind/field/wind_field.hpp"
#include "engine/wind/turbulence/wind_spectrum.hpp"

namespace yuragi::wind::field {

/// u and w have most of their power in different waves: if each were the same in both, the stress would be 0.63.
inline constexpr double kMaxStress = 0.6;

/// What wind a field has. The components along the wind, across it and upward have standard deviations of
/// (1, 0.8, 0.5) sigma and integral length scales of (1, 1/3, 1/12.3) L (IEC 61400-1:2005, annex B.2).
struct WindFieldSettings {
  int dims = 2;                       ///< 2 or 3
  double speed_m_s = 8.0;             ///< mean U, 0 or above
  double direction_deg = 270.0;       ///< where it comes from
  double turbulence_intensity = 0.2;  ///< sigma / U along the wind, 0 or above
  double length_m = 57.0;             ///< L, integral length scale of u along the wind, above 0; the IEC's at 10 m
  std::size_t samples = 256;          ///< an edge of the tile: a power of two, 8 to 4096 (2-D) or 256 (3-D)
  double spacing_m = 1.0;             ///< between its samples, above 0
  /// cov(u, w) / (sigma_u sigma_w): near the ground about -0.3, because gusts come down and lulls rise (Panofsky and
  /// Dutton 1984, Atmospheric turbulence, chapter 6). -kMaxStress to kMaxStress, and 0 in two dimensions.
  double stress = 0.0;
  bool evolves = true;  ///< eddies turn over while they are carried; false: Taylor's frozen turbulence
  std::uint64_t seed = 1;
};

/// A wind with von Karman's turbulence, known at every place and time: a tile of noise whose wave vectors have the
/// power of VonKarmanModes, carried by the mean wind along its direction at its speed.
///
/// A point has von Karman's spectrum of (U, TI, L) for u, the transverse one for v and w; two points across the wind
/// have the coherence of W13. Waves longer than the tile are the same everywhere in it: a 1-D noise along the wind's
/// path. Waves shorter than two samples are missing, and variance_m2_s2() is that of the others. The tile repeats every
/// samples x spacing; a frozen one repeats after that distance. The field is not free of divergence.
///
/// Without `stress` the components are independent of each other, as in isotropic turbulence. With it each wave of w
/// has the same correlation with that wave of u, which gives the stress: variances, spectra and coherences are the same
/// for every stress, unlike with a rotation of one component into the other, or with a sheared tensor (Mann 1994).
/// Effects of shear that it lacks: in nature short waves are less correlated than long ones (the cospectrum falls as
/// k^-7/3), and eddies are tilted.
///
/// Time can go either way. Owns its tiles (about 36 bytes a sample in 2-D, 44 in 3-D). Same settings, same bits.
/// Thread-safe: reading, yes. Realtime-safe: at(); go_to() makes 2 or 3 Fourier transforms.
class SpectralWindField final : public WindField {
 public:
  /// Starts at time 0. Throws std::invalid_argument if the settings are not allowed, and std::bad_alloc.
  explicit SpectralWindField(const WindFieldSettings& settings);

  void go_to(double time_s) noexcept;

  int dims() const noexcept override { return noise_.dims(); }
  /// Linear between samples, which weakens the shortest waves: read exact values at samples.
  WindVector3 at(WindPlace place) const noexcept override;

  /// Of a component, mean over seeds and long times. The third is 0 in two dimensions.
  double variance_m2_s2(turbulence::WindComponent component) const noexcept;
  /// Of u and w, mean over seeds: the stress times both standard deviations. 0 in two dimensions.
  double along_up_covariance_m2_s2() const noexcept;
  /// How long the tile is.
  double period_m() const noexcept { return period_m_; }

 private:
  /// The part of a component's gusts that is longer than the tile.
  struct Way {
    noise::Tile1 noise;
    double deviation_m_s = 0.0;
  };
  static Way make_way(const WindFieldSettings& settings, turbulence::WindComponent component, std::uint64_t seed);
  static double likeness_of(const WindFieldSettings& settings);
  static std::vector<noise::MovingField> fields_of(const WindFieldSettings& settings, double likeness);
  SpectralWindField(const WindFieldSettings& settings, double likeness);

  double period_m_;
  double speed_m_s_;
  double stress_;
  Vector ahead_;                     ///< unit vector downwind
  double turning_rad_s_ = 0.0;       ///< of the eddies as long as the tile
  noise::MovingNoise noise_;         ///< a field a component
  std::vector<Way> ways_;            ///< one a component
  std::array<double, 3> now_m_s_{};  ///< the ways' contribution at this moment
};

}  // namespace yuragi::wind::field
