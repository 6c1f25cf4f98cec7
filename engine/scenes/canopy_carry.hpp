#pragma once

#include <cmath>

namespace yuragi::scenes {

/// The speed of the waves of a stand of plants, as a part of the wind at 10 m, which is the wind of the scenes
/// (`scene_height` of a sensor's calibration is 10 m unless it is set). `plant_height_m`: above 0, at most 5.
///
/// They run at 1.8 times the wind at the tops of the plants, and that is 3.3 u*; the logarithmic profile above a stand
/// of height h begins at d = 0.67 h with the roughness 0.1 h (Raupach, Finnigan and Brunet 1996, "Coherent eddies and
/// turbulence in vegetation canopies: the mixing-layer analogy"). So with W8 of engine/wind/model.md
///
///   carry = 1.8 * 3.3 u* / U(10 m) = 1.8 * 3.3 * 0.41 / ln((10 m - 0.67 h) / (0.1 h))
///
/// 0.42 at 0.3 m, 0.50 at 0.7 m, 0.54 at 1 m, 0.65 at 2 m. Thread-safe and realtime-safe: yes.
inline double canopy_carry(double plant_height_m) noexcept {
  constexpr double kWaveOverTops = 1.8;
  constexpr double kTopsOverFriction = 3.3;
  constexpr double kKarman = 0.41;
  constexpr double kWindHeight_m = 10.0;
  const double displacement_m = 0.67 * plant_height_m;
  const double roughness_m = 0.1 * plant_height_m;
  return kWaveOverTops * kTopsOverFriction * kKarman / std::log((kWindHeight_m - displacement_m) / roughness_m);
}

}  // namespace yuragi::scenes
