#pragma once

#include <array>
#include <string_view>

#include "drivers/decode/speed_units.hpp"

namespace yuragi::drivers::sensor {

/// The units of speed that can be set for messages without a unit.
inline constexpr std::array<std::string_view, 5> kSpeedUnitNames = {"m/s", "km/h", "kn", "mph", "ft/s"};

/// The factor to m/s of one of kSpeedUnitNames.
constexpr double metres_per_second_in(std::string_view unit) noexcept {
  return decode::speed_unit_of_word(unit).value_or(decode::kMetresPerSecondUnit).metres_per_second;
}

}  // namespace yuragi::drivers::sensor
