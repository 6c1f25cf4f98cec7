#pragma once

#include <span>

#include "drivers/driver.hpp"
#include "engine/base/parameter.hpp"
#include "engine/wind/blend_settings.hpp"

namespace yuragi {

/// What the table [sensor.blend] of a sensor may hold: its part among several.
std::span<const Parameter> sensor_blend_parameters();

ParameterValues default_sensor_blend();

/// The same for the estimator. `values` are those of the table, `driver` the sensor's.
BlendSourceSettings blend_source_of(const ParameterValues& values, const DriverDescription& driver);

}  // namespace yuragi
