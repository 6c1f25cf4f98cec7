#pragma once

#include "engine/wind/turbulence/wind_spectrum.hpp"

namespace yuragi::wind::field {

/// The distribution of the variance of one component of isotropic turbulence over wave vectors: von Karman's, in three
/// dimensions and, for a level plane through it, in two. A straight line along the wind through it has von Karman's
/// spectrum (WindSpectrum: the longitudinal one for u, the transverse one for v and w), and two lines side by side have
/// the coherence that goes with it (engine/wind/model.md W13).
///
/// With the energy E(k) ~ k^4 / (kappa^2 + k^2)^(17/6), a component has the density E(k) (k^2 - k_own^2) / (4 pi k^4),
/// k_own the part of k along its own axis. Source: von Karman 1948, Progress in the statistical theory of turbulence;
/// Batchelor 1953, The theory of homogeneous turbulence, chapter 3.
///
/// Thread-safe and realtime-safe: yes.
class VonKarmanModes {
 public:
  /// Of a component with standard deviation `sigma_m_s` (0 or above) whose integral length scale along the mean wind is
  /// `length_m` (above 0).
  VonKarmanModes(turbulence::WindComponent component, double sigma_m_s, double length_m) noexcept;

  /// Of a component in the plane (u or v), m^2/s^2 per (rad/m)^2: the integral over the plane is the variance.
  double plane_density(double along_rad_m, double across_rad_m) const noexcept;
  /// m^2/s^2 per (rad/m)^3: the integral over all wave vectors is the variance.
  double space_density(double along_rad_m, double across_rad_m, double up_rad_m) const noexcept;

 private:
  turbulence::WindComponent component_;
  double kappa_squared_;
  double scale_;
};

}  // namespace yuragi::wind::field
