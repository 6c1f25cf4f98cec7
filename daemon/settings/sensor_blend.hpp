#pragma once

#include <optional>
#include <span>
#include <string>

#include "drivers/sensor/driver.hpp"
#include "engine/base/parameter.hpp"
#include "engine/base/result.hpp"
#include "engine/wind/blend/blend_settings.hpp"

namespace yuragi::daemon::settings {

/// The keys of [sensor.blend]: the sensor's share among several.
std::span<const Parameter> sensor_blend_parameters();

/// Returns what a sensor's speed is: by the values of sensor_blend_parameters(), or if those are "auto" and 0, by what
/// the driver states. kUnknown if nothing is stated; the blend then assumes one (wind::assumed_value). Pure.
drivers::sensor::StatedValue sensor_value_of(const ParameterValues& values,
                                             const std::optional<drivers::sensor::StatedValue>& stated);

/// From the values of sensor_blend_parameters(), with the driver's defaults if they are "auto"; length_m, and what
/// sensor_value_of() returns, are not set.
/// An error (values that contradict each other) names the key.
Result<wind::blend::SourceSettings, ParameterError> blend_source_of(const ParameterValues& values,
                                                                    const drivers::sensor::DriverDescription& driver);

/// Where the sensor stands, for a person: "at the windward edge of the scenes", "12 m east and 3 m north of the
/// middle of the scenes, taken 20 m upwind of there".
std::string place_text(const wind::blend::SourceSettings& source);

}  // namespace yuragi::daemon::settings
