#pragma once

#include <cmath>

namespace yuragi::wind::turbulence {

// Von Karman's spectrum of the wind's component along the mean wind, at one place. x = f T is without unit: f the
// frequency, T = L / U the integral length scale over the mean speed. Times variance and T it is the one-sided spectral
// density, m^2/s^2/Hz. Source: von Karman 1948, Progress in the statistical theory of turbulence; the constant as in
// ESDU 85020. Thread-safe and realtime-safe.

/// (2 pi 1.339)^2 as it is printed: where the density bends. engine/noise/von_karman_corner.hpp says what 1.339 is.
inline constexpr double kVonKarmanBend = 70.8;

/// S / (variance T) at x = f T: 4 / (1 + 70.8 x^2)^(5/6). Its integral over x from 0 on is 1.
inline double von_karman_density(double x) noexcept {
  return 4.0 / std::pow(1.0 + kVonKarmanBend * x * x, 5.0 / 6.0);
}

/// The factor of the inertial range, where x is far above 1: there the density is this times x^(-5/3).
inline double von_karman_inertial_factor() noexcept {
  return 4.0 / std::pow(kVonKarmanBend, 5.0 / 6.0);
}

}  // namespace yuragi::wind::turbulence
