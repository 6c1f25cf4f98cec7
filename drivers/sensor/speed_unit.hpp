#pragma once

#include <array>
#include <string_view>

namespace yuragi::drivers::sensor {

/// A unit of speed that a message may come in.
struct SpeedUnit {
  std::string_view name;
  double metres_per_second;
};
inline constexpr std::array<SpeedUnit, 5> kSpeedUnitTable = {
    {{"m/s", 1.0}, {"km/h", 1.0 / 3.6}, {"kn", 1852.0 / 3600.0}, {"mph", 0.44704}, {"ft/s", 0.3048}}};
inline constexpr std::array<std::string_view, 5> kSpeedUnitNames = {"m/s", "km/h", "kn", "mph", "ft/s"};

/// The factor to m/s of one of kSpeedUnitNames.
constexpr double metres_per_second_in(std::string_view unit) noexcept {
  for (const SpeedUnit& one : kSpeedUnitTable) {
    if (one.name == unit) return one.metres_per_second;
  }
  return 1.0;
}

}  // namespace yuragi::drivers::sensor
