#pragma once

#include <cstdint>

#include "engine/noise/noise_tile.hpp"
#include "engine/wind/wind_vector.hpp"

namespace yuragi::wind::turbulence {

/// The wind of a place without a sensor: its mean and its turbulence.
struct SyntheticWindSettings {
  double mean_speed_m_s = 4.0;
  double mean_direction_deg = 240.0;   ///< where it comes from
  double turbulence_intensity = 0.25;  ///< standard deviation along the wind / mean speed
  std::uint64_t seed = 1;
};

/// Wind made of 1/f^(5/3) noise (Kolmogorov's slope) about a mean, along and across it; the standard deviation across
/// is 0.8 of that along (IEC 61400-1:2019, normal turbulence). The same settings give the same wind, bit for bit.
///
/// Each component adds two noises whose periods (17 min and 28 min) have an irrational ratio, so that no repeat is
/// seen. Thread-safe: at() may be called from any thread. Realtime-safe after construction: yes.
class SyntheticWind {
 public:
  explicit SyntheticWind(const SyntheticWindSettings& settings);

  /// The wind at a time, smooth in it (continuous first derivative). Finite for every finite time.
  Vector at(double time_s) const noexcept;

  const SyntheticWindSettings& settings() const noexcept { return settings_; }

 private:
  struct Component {
    noise::Tile1 fast, slow;
    double at(double time_s) const noexcept;  ///< unit variance
  };

  SyntheticWindSettings settings_;
  Vector along_, across_;  ///< unit vectors: downwind, and to the left of it
  Component along_noise_, across_noise_;
};

}  // namespace yuragi::wind::turbulence
