#pragma once

#include <vector>

#include "drivers/sensor/device_claim.hpp"
#include "drivers/text/text_sensor.hpp"
#include "engine/base/parameter.hpp"

namespace yuragi::drivers::text {

/// The parameters of drivers that read text from a byte port: its source, the request for it, and when a
/// silent device is opened again. `own` are the driver's, which come first; `delay_after_open_s` is a default.
std::vector<Parameter> with_byte_port_parameters(std::vector<Parameter> own, double delay_after_open_s);

/// The values of these, and of "interface" where a driver's transport may be "can". Throws std::runtime_error, saying
/// what to do, where they cannot work together.
TextSensorSettings text_sensor_settings_of(const ParameterValues& values);

/// What a sensor of such values has to itself: its serial port, or its UDP port.
std::vector<sensor::DeviceClaim> byte_port_claims(const ParameterValues& values);

}  // namespace yuragi::drivers::text
