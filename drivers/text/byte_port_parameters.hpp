#pragma once

#include <span>
#include <vector>

#include "drivers/sensor/endpoint.hpp"
#include "drivers/text/text_sensor.hpp"
#include "engine/base/parameter.hpp"

namespace yuragi::drivers::text {

/// The parameters of drivers that read text from a byte port: its source, the request for it, and when a
/// silent device is opened again. `own` are the driver's, which come first; `delay_after_open_s` is a default.
std::vector<Parameter> with_byte_port_parameters(std::span<const Parameter> own, double delay_after_open_s);

/// The values of these, and of "interface" if a driver's transport may be "can". Throws std::runtime_error, with what
/// to do, if they cannot work together.
SensorSettings text_sensor_settings_of(const ParameterValues& values);

/// Where a sensor of such values reads, as it is configured, and the endpoint that this is. Do not throw.
bus::BytePortAddress byte_port_address_of(const ParameterValues& values);
std::vector<sensor::Endpoint> byte_port_endpoints(const ParameterValues& values);

}  // namespace yuragi::drivers::text
