#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace yuragi {

/// The points of the compass, clockwise from north, each for the sector of 22.5 degrees around it.
inline constexpr std::array<std::string_view, 16> kCompassPoints = {"N", "NNE", "NE", "ENE", "E", "ESE", "SE", "SSE",
                                                                    "S", "SSW", "SW", "WSW", "W", "WNW", "NW", "NNW"};
inline constexpr double kDegPerCompassPoint = 22.5;

/// The point nearest to a direction (any finite number of degrees, clockwise from north): 247 is "WSW".
/// Thread-safe and realtime-safe.
std::string_view nearest_compass_point(double direction_deg) noexcept;

/// The direction of a compass point, 0 to 337.5 degrees: "wsw" is 247.5; in capitals or not. Nullopt if the name is
/// unknown. Thread-safe and realtime-safe.
std::optional<double> compass_point_deg(std::string_view name) noexcept;

}  // namespace yuragi
