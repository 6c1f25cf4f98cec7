#pragma once

#include <cmath>

namespace yuragi::wind::turbulence {

// Von Karman's spectra of the wind's components along the mean wind and across it, at one place (engine/wind/model.md
// W5). x = f T is without unit: f the frequency, T = L / U the integral length scale of u over the mean speed, for
// both. Times the component's variance and T they are one-sided spectral densities, m^2/s^2/Hz. Source: von Karman
// 1948, Progress in the statistical theory of turbulence; the constant as in ESDU 85020. Thread-safe and realtime-safe.

/// (2 pi 1.339)^2, as printed: the corner of the density. engine/noise/von_karman_corner.hpp defines 1.339.
inline constexpr double kVonKarmanBend = 70.8;

/// S / (variance T) at x = f T: 4 / (1 + 70.8 x^2)^(5/6). Its integral over x from 0 on is 1.
inline double von_karman_density(double x) noexcept {
  return 4.0 / std::pow(1.0 + kVonKarmanBend * x * x, 5.0 / 6.0);
}

/// The same of v: 2 (1 + 188.8 x^2) / (1 + 70.8 x^2)^(11/6). Its integral over x from 0 on is 1.
inline double von_karman_density_across(double x) noexcept {
  const double bent = kVonKarmanBend * x * x;
  return 2.0 * (1.0 + 8.0 / 3.0 * bent) / std::pow(1.0 + bent, 11.0 / 6.0);
}

/// The factor of the inertial range of u, for x far above 1: there the density is this times x^(-5/3).
inline double von_karman_inertial_factor() noexcept {
  return 4.0 / std::pow(kVonKarmanBend, 5.0 / 6.0);
}

}  // namespace yuragi::wind::turbulence
