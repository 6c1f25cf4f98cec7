#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "engine/base/units.hpp"

namespace yuragi::drivers::decode {

// The words for units of speed that devices, publishers and loggers write. Nothing here allocates or throws.
// Thread-safe and realtime-safe: yes.

struct SpeedUnit {
  std::string_view name;  ///< as this project writes it
  double metres_per_second;
};

inline constexpr SpeedUnit kMetresPerSecondUnit{"m/s", 1.0};
inline constexpr SpeedUnit kKilometresPerHourUnit{"km/h", kMetresPerSecondPerKmh};
inline constexpr SpeedUnit kKnotUnit{"kn", kMetresPerSecondPerKnot};
inline constexpr SpeedUnit kMilesPerHourUnit{"mph", kMetresPerSecondPerMph};
inline constexpr SpeedUnit kFeetPerSecondUnit{"ft/s", 0.3048};
inline constexpr SpeedUnit kYardsPerSecondUnit{"yd/s", 0.9144};
inline constexpr SpeedUnit kDecimetresPerSecondUnit{"dm/s", 0.1};
inline constexpr SpeedUnit kCentimetresPerSecondUnit{"cm/s", 0.01};

struct SpeedWord {
  std::string_view word;
  SpeedUnit unit;
};

/// All of them, in lower case; each unit's own name is the first of its words.
inline constexpr std::array kSpeedWords = {
    SpeedWord{"m/s", kMetresPerSecondUnit},
    SpeedWord{"mps", kMetresPerSecondUnit},
    SpeedWord{"m s-1", kMetresPerSecondUnit},
    SpeedWord{"m/sec", kMetresPerSecondUnit},
    SpeedWord{"m per s", kMetresPerSecondUnit},
    SpeedWord{"meter/second", kMetresPerSecondUnit},
    SpeedWord{"meters/second", kMetresPerSecondUnit},
    SpeedWord{"metre/second", kMetresPerSecondUnit},
    SpeedWord{"metres/second", kMetresPerSecondUnit},
    SpeedWord{"meter/sec", kMetresPerSecondUnit},
    SpeedWord{"meters/sec", kMetresPerSecondUnit},
    SpeedWord{"meters per second", kMetresPerSecondUnit},
    SpeedWord{"metres per second", kMetresPerSecondUnit},
    SpeedWord{"km/h", kKilometresPerHourUnit},
    SpeedWord{"kmh", kKilometresPerHourUnit},
    SpeedWord{"km h-1", kKilometresPerHourUnit},
    SpeedWord{"kph", kKilometresPerHourUnit},
    SpeedWord{"kmph", kKilometresPerHourUnit},
    SpeedWord{"km/hr", kKilometresPerHourUnit},
    SpeedWord{"kilometer/hour", kKilometresPerHourUnit},
    SpeedWord{"kilometers/hour", kKilometresPerHourUnit},
    SpeedWord{"kilometres/hour", kKilometresPerHourUnit},
    SpeedWord{"kilometers per hour", kKilometresPerHourUnit},
    SpeedWord{"kilometres per hour", kKilometresPerHourUnit},
    SpeedWord{"kn", kKnotUnit},
    SpeedWord{"kt", kKnotUnit},
    SpeedWord{"kts", kKnotUnit},
    SpeedWord{"knt", kKnotUnit},
    SpeedWord{"knts", kKnotUnit},
    SpeedWord{"knot", kKnotUnit},
    SpeedWord{"knots", kKnotUnit},
    SpeedWord{"mph", kMilesPerHourUnit},
    SpeedWord{"mi/h", kMilesPerHourUnit},
    SpeedWord{"mi/hr", kMilesPerHourUnit},
    SpeedWord{"mile/hour", kMilesPerHourUnit},
    SpeedWord{"miles/hour", kMilesPerHourUnit},
    SpeedWord{"miles per hour", kMilesPerHourUnit},
    SpeedWord{"ft/s", kFeetPerSecondUnit},
    SpeedWord{"fps", kFeetPerSecondUnit},
    SpeedWord{"ft/sec", kFeetPerSecondUnit},
    SpeedWord{"feet/sec", kFeetPerSecondUnit},
    SpeedWord{"feet/second", kFeetPerSecondUnit},
    SpeedWord{"feet per second", kFeetPerSecondUnit},
    SpeedWord{"yd/s", kYardsPerSecondUnit},
    SpeedWord{"dm/s", kDecimetresPerSecondUnit},
    SpeedWord{"cm/s", kCentimetresPerSecondUnit},
};

/// Returns the unit that is written exactly so; nullopt for any other word.
constexpr std::optional<SpeedUnit> speed_unit_of_word(std::string_view word) noexcept {
  for (const SpeedWord& each : kSpeedWords) {
    if (each.word == word) return each.unit;
  }
  return std::nullopt;
}

}  // namespace yuragi::drivers::decode
