#pragma once

#include <algorithm>

#include "engine/wind/gust_noise.hpp"
#include "engine/wind/wind_state.hpp"
#include "engine/wind/wind_vector.hpp"

namespace yuragi {

/// How the measured wind changes from place to place where several anemometers stand along a wall: a plane through what
/// they say, which goes on level beyond the outermost of them. Without a slope: the same everywhere.
struct WindSlope {
  WindVector per_m_east, per_m_south;   ///< (m/s) / m
  double west_m = 0.0, east_m = 0.0;    ///< where the plane ends, metres east of the middle of the scene
  double north_m = 0.0, south_m = 0.0;  ///< and south of it

  /// By how much the wind at a place differs from that in the middle of the scene.
  WindVector at(double at_east_m, double at_south_m) const noexcept {
    const double east = std::clamp(at_east_m, west_m, east_m) - std::clamp(0.0, west_m, east_m);
    const double south = std::clamp(at_south_m, north_m, south_m) - std::clamp(0.0, north_m, south_m);
    return east * per_m_east + south * per_m_south;
  }
};

/// The wind over the ground at one moment: what all places have alike, how what is measured changes from place to
/// place, and the gusts that differ from place to place. Finite.
struct GroundWind {
  WindVector everywhere;    ///< in the middle of the scene
  WindSlope slope;          ///< elsewhere; none unless sensors stand at several places
  GustNoise::Moment gusts;  ///< of these the octaves of the tiles; those of the way are in `everywhere`

  GroundWind() = default;
  /// The same wind everywhere.
  GroundWind(WindVector wind) : everywhere(wind) {}  // NOLINT(google-explicit-constructor): a wind is a wind

  /// What the wind at a place (metres east and south of the middle of the scene) has without the place's own gusts:
  /// `everywhere`, and the slope. Thread-safe and realtime-safe: yes.
  WindVector smooth_at(double east_m, double south_m) const noexcept { return everywhere + slope.at(east_m, south_m); }

  /// The wind at a place. Thread-safe and realtime-safe: yes.
  WindVector at(const GustNoise& noise, double east_m, double south_m) const noexcept {
    return smooth_at(east_m, south_m) + noise.local(gusts, east_m, south_m);
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
  wind.slope.per_m_east = gain * wind.slope.per_m_east;
  wind.slope.per_m_south = gain * wind.slope.per_m_south;
  for (float& deviation : wind.gusts.along_m_s) deviation *= static_cast<float>(gain);
  for (float& deviation : wind.gusts.across_m_s) deviation *= static_cast<float>(gain);
  return wind;
}

}  // namespace yuragi
