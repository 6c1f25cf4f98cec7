#pragma once

#include <cstdint>

#include "engine/base/state_pass.hpp"
#include "engine/base/time.hpp"
#include "engine/wind/wind_vector.hpp"

namespace yuragi::wind {

/// The source of the wind at a moment.
enum class Source : std::uint8_t {
  kDefault,   ///< no live sensor: the installation's default synthetic wind
  kHandover,  ///< changing from one to the other
  kLive,      ///< a sensor
};

/// The wind that moves things, at one moment. Always finite, continuous in time.
struct State {
  MonoTime time{};
  Vector wind;
  Source source = Source::kDefault;
  double live_weight = 0.0;    ///< 0: all default wind; 1: all sensor
  double reading_age_s = 0.0;  ///< of the newest reading that was used; 0 if there was none
  /// The distance of the place of this wind upwind of the middle of the scenes (negative: downwind): their windward
  /// edge, or the sensor's configured position. Its gusts then cross the scenes.
  double upwind_m = 0.0;
  double to_middle_s = 0.0;  ///< the time of a gust from there to the middle; 0 if it has already passed it
  /// true: that place is the sensors' configured position; false: it is the windward edge
  bool is_place_configured = false;

  void list_state(StatePass& pass) {
    pass(time, wind, live_weight, upwind_m, is_place_configured);
    pass.choice(source, Source::kLive);
    pass.total(reading_age_s);
    pass.total(to_middle_s);
  }
};

}  // namespace yuragi::wind
