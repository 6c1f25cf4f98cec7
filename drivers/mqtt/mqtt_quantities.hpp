#pragma once

#include <optional>

#include "drivers/mqtt/mqtt_payload.hpp"
#include "engine/wind/station_quantities.hpp"

namespace yuragi::drivers::mqtt {

// The other quantities of known publishers, without their time; nullopt if a message has none. Values are not checked
// for their range (wind::plausible_part). Sources: drivers/SOURCES.md S5.1.

/// Of one message of rtl_433: temperature_C or temperature_F, humidity, pressure_hPa, rain_mm or rain_in,
/// rain_rate_mm_h or rain_rate_in_h.
std::optional<wind::StationQuantities> quantities_of_rtl_433(const Payload& payload);

/// Of one SENSOR message of Tasmota: Temperature (in TempUnit), Humidity and Pressure (in PressureUnit), each of them
/// if exactly one of the sensors of the device has it. The chip's own temperature ("ESP32") does not count.
std::optional<wind::StationQuantities> quantities_of_tasmota(const Payload& payload);

}  // namespace yuragi::drivers::mqtt
