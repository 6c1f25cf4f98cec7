#pragma once

#include <cstdint>

#include "engine/base/time.hpp"
#include "engine/wind/wind_vector.hpp"

namespace yuragi::wind {

/// Where the wind of a moment comes from.
enum class WindSource : std::uint8_t {
  kDefault,   ///< no live sensor: the installation's default synthetic wind
  kHandover,  ///< on the way from one to the other
  kLive,      ///< a sensor
};

/// The wind that moves things, at one moment. Always finite, continuous in time.
struct WindState {
  MonoTime time{};
  WindVector wind;
  WindSource source = WindSource::kDefault;
  double live_weight = 0.0;    ///< 0: all default wind; 1: all sensor
  double reading_age_s = 0.0;  ///< of the newest reading that took part; 0 if there was none
  /// This is the wind so far upwind of the middle of the scenes (below 0: downwind): at their windward edge, or where
  /// the sensor's configured position is. What blows there now crosses the scenes.
  double upwind_m = 0.0;
  double to_middle_s = 0.0;  ///< how long a gust takes from there to the middle; 0 if it has passed it already
  /// That place is the sensors' configured position; otherwise it is the windward edge.
  bool is_place_configured = false;
};

}  // namespace yuragi::wind
