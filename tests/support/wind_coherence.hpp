#pragma once

#include <cmath>

#include "engine/noise/von_karman_corner.hpp"

namespace yuragi {

// The coherence (the root of the squared one) of u at two places `distance_m` apart across the wind.

/// exp(-C f d / U), with the decay C about 7 vertically and 10 to 16 sideways. Source: Davenport 1961.
inline double davenport_coherence(double frequency_hz, double distance_m, double speed_m_s, double decay) {
  return std::exp(-decay * frequency_hz * distance_m / speed_m_s);
}

/// With its sign, in von Karman's turbulence, at the wavenumber `along_rad_m` = 2 pi f / U; `length_m`: integral length
/// scale of u along the wind. For distances small against L it is within 0.09 of davenport_coherence() with a decay of
/// 7, and 0.19 of that with 10. Source: Harris 1971, The nature of the wind; IEC 61400-1, annex B (the coherence of the
/// isotropic model).
inline double von_karman_coherence(double along_rad_m, double distance_m, double length_m) {
  constexpr double kGammaOfFiveSixths = 1.1287870299081257;
  const double x = std::abs(distance_m) * std::hypot(along_rad_m, 1.0 / (noise::kVonKarmanCorner * length_m));
  if (x < 1e-9) return 1.0;
  if (x > 500.0) return 0.0;
  return std::pow(2.0, 1.0 / 6.0) / kGammaOfFiveSixths *
         (std::pow(x, 5.0 / 6.0) * std::cyl_bessel_k(5.0 / 6.0, x) -
          0.5 * std::pow(x, 11.0 / 6.0) * std::cyl_bessel_k(1.0 / 6.0, x));
}

}  // namespace yuragi
