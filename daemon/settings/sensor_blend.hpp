#pragma once

#include <span>
#include <string>

#include "drivers/sensor/driver.hpp"
#include "engine/base/parameter.hpp"
#include "engine/base/result.hpp"
#include "engine/wind/blend/blend_settings.hpp"

namespace yuragi {

/// What the table [sensor.blend] of a sensor may hold: its part among several.
std::span<const Parameter> sensor_blend_parameters();

/// Of the values of sensor_blend_parameters() and the sensor's driver, which says what they leave to it; without a
/// length of the gusts. The error, what does not fit together, names the key that it is about.
Result<BlendSourceSettings, ParameterError> blend_source_of(const ParameterValues& values,
                                                            const DriverDescription& driver);

/// Where the sensor stands, for a person: "at the windward edge of the scenes", "12 m east and 3 m north of the
/// middle of the scenes, taken 20 m upwind of there".
std::string place_text(const BlendSourceSettings& source);

}  // namespace yuragi
