#pragma once

#include <optional>
#include <span>
#include <string>

#include "drivers/sensor/driver.hpp"
#include "engine/base/parameter.hpp"
#include "engine/wind/blend/blend_settings.hpp"

namespace yuragi {

/// What the table [sensor.blend] of a sensor may hold: its part among several.
std::span<const Parameter> sensor_blend_parameters();

ParameterValues default_sensor_blend();

/// What does not fit together in it, with the key that it is about; nothing where all fits.
std::optional<ParameterError> sensor_blend_mistake(const ParameterValues& values);

/// Where the sensor stands, for a person: "at the windward edge of the scenes", "12 m east and 3 m north of the
/// middle of the scenes, taken 20 m upwind of there".
std::string place_text(const BlendSourceSettings& source);

/// The same for the estimator. `values` are those of the table, `driver` the sensor's.
BlendSourceSettings blend_source_of(const ParameterValues& values, const DriverDescription& driver);

}  // namespace yuragi
