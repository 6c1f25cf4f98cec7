#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/base/state_pass.hpp"
#include "engine/math/portable.hpp"
#include "engine/noise/von_karman_corner.hpp"

namespace yuragi::wind::ground {

/// The part of a gust measured at one place that is still known at another (engine/wind/model.md W24): the root
/// coherence
///
///     g = exp(-distance q kappa(f)),  kappa(f) = sqrt(k^2 + 1 / (1.339 L)^2),  k = 2 pi f / U,
///
/// where `distance` counts metres across the wind C_y / (2 pi) times and metres along it C_x / (2 pi) times. Across,
/// C_y = 12 (IEC 61400-1:2005, annex B.2, whose 0.12 d / L_c is the term with L; Davenport 1961 has 10 to 16). Along,
/// C_x grows with the turbulence intensity: 0.025 + 5.7 TI (Simley and Pao 2015, A longitudinal spatial coherence model
/// for wind evolution based on large-eddy simulation; half of it, because theirs is the squared coherence, with a total
/// deviation of 1.35 sigma_u). Both laws are of ordinary wind. In light wind, which is more turbulent, gusts are wider
/// and live longer than by these laws: beyond an intensity of 0.2 C_y falls as 0.2 / TI, beyond 0.33 the rise of C_x as
/// 0.33 / TI (fitted to pairs of sonic anemometers 5 to 55 m apart, wind of 0.6 to 1.9 m/s, TI 0.8). Changes over more
/// than some minutes are weather, the same everywhere, and are never lost: q goes from 0 to 1 over the octave above
/// 0.003 Hz, or above the frequency of the longest wave.
///
/// A value. All functions: thread-safe and realtime-safe.
struct GustCoherence {
  double speed_m_s = 1.0;           ///< U, that carries the gusts; above 0
  double length_m = 57.0;           ///< L, integral length scale; above 0
  double decay_across = 12.0;       ///< C_y
  double decay_along = 1.0;         ///< C_x
  double longest_wave_m = 2'048.0;  ///< longer waves are the same everywhere

  void list_state(StatePass& pass) {
    for (double* above_0 : {&speed_m_s, &length_m, &longest_wave_m}) pass.within(*above_0, 1e-6, StatePass::kLargest);
    pass(decay_across, decay_along);
  }

  /// C_y of a turbulence intensity.
  static double decay_across_of(double turbulence_intensity) noexcept {
    return 12.0 / std::max(1.0, turbulence_intensity / 0.2);
  }
  /// C_x of a turbulence intensity.
  static double decay_along_of(double turbulence_intensity) noexcept {
    return std::max(0.5, (0.025 + 5.7 * turbulence_intensity) / std::max(1.0, turbulence_intensity / 0.33));
  }

  /// The distance of a place at this offset along and across the way from the place of the measurement, m.
  double distance_m(double along_m, double across_m) const noexcept {
    return (decay_across * std::abs(across_m) + decay_along * std::abs(along_m)) / (2.0 * std::numbers::pi);
  }

  /// q kappa(f), 1/m; 0 for waves that are the same everywhere.
  double loss_per_m(double frequency_hz) const noexcept {
    constexpr double kWeather_hz = 0.003;
    const double wavenumber_rad_m = 2.0 * std::numbers::pi * frequency_hz / speed_m_s;
    const double longest_hz = speed_m_s / longest_wave_m;
    const double travels = std::clamp(std::log2(frequency_hz / std::max(longest_hz, kWeather_hz)), 0.0, 1.0);
    return travels * math::length(wavenumber_rad_m, 1.0 / (noise::kVonKarmanCorner * length_m));
  }
};

}  // namespace yuragi::wind::ground
