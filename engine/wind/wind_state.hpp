#pragma once

#include <cstdint>

#include "engine/base/time.hpp"
#include "engine/wind/wind_vector.hpp"

namespace yuragi {

/// Where the wind of a moment comes from.
enum class WindSource : std::uint8_t {
  kDefault,   ///< no sensor speaks: the installation's default synthetic wind
  kHandover,  ///< on the way from one to the other
  kLive,      ///< a sensor
};

/// The wind that moves things, at one moment. Always finite, continuous in time.
struct WindState {
  MonoTime time{};
  WindVector wind;
  WindSource source = WindSource::kDefault;
  double live_weight = 0.0;    ///< 0: all default wind; 1: all sensor
  double reading_age_s = 0.0;  ///< of the newest reading that took part; 0 where there was none
};

}  // namespace yuragi
