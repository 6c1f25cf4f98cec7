#pragma once

#include "engine/wind/gust_noise.hpp"
#include "engine/wind/wind_state.hpp"
#include "engine/wind/wind_vector.hpp"

namespace yuragi {

/// The wind over the ground at one moment: what all places have alike, and the gusts that differ from place to place.
/// Finite.
struct GroundWind {
  WindVector everywhere;
  GustNoise::Moment gusts;  ///< of these the octaves of the tiles; those of the way are in `everywhere`

  GroundWind() = default;
  /// The same wind everywhere.
  GroundWind(WindVector wind) : everywhere(wind) {}  // NOLINT(google-explicit-constructor): a wind is a wind

  /// The wind at a place, metres east and south of the middle of the scene. Thread-safe and realtime-safe: yes.
  WindVector at(const GustNoise& noise, double east_m, double south_m) const noexcept {
    return everywhere + noise.local(gusts, east_m, south_m);
  }
};

/// The wind that moves the scenes: what it is in the middle, for people to see, and over the ground.
struct DrivingWind {
  WindState state;
  GroundWind ground;
};

/// A wind that is stronger by a factor, blowing as far.
inline GroundWind operator*(double gain, GroundWind wind) noexcept {
  wind.everywhere = gain * wind.everywhere;
  for (float& deviation : wind.gusts.along_m_s) deviation *= static_cast<float>(gain);
  for (float& deviation : wind.gusts.across_m_s) deviation *= static_cast<float>(gain);
  return wind;
}

}  // namespace yuragi
