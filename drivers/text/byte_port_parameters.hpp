#pragma once

#include <vector>

#include "drivers/bus/byte_port.hpp"
#include "drivers/sensor/device_claim.hpp"
#include "drivers/sensor/value_selection.hpp"
#include "engine/base/parameter.hpp"

namespace yuragi::drivers::text {

/// The parameters of drivers that read text from a byte port: its source, the request for it, and when a
/// silent device is opened again. `own` are the driver's, which come first; `delay_after_open_s` is a default.
std::vector<Parameter> with_byte_port_parameters(std::vector<Parameter> own, double delay_after_open_s);

/// The address in such values, and in "interface" where a driver's transport may be "can". Throws std::runtime_error,
/// saying what to do, where they cannot work together.
bus::BytePortAddress byte_port_address_of(const ParameterValues& values);

/// What a sensor of such values has to itself: its serial port, or its UDP port.
std::vector<sensor::DeviceClaim> byte_port_claims(const ParameterValues& values);

/// The part of the setting "reference" (chosen_wind_parameters()).
sensor::SelectedPart reference_part(const ParameterValues& values);

}  // namespace yuragi::drivers::text
