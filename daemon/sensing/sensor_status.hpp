#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "daemon/sensing/sensor_diagnosis.hpp"
#include "daemon/sensing/sensor_runner.hpp"
#include "drivers/sensor/sensor.hpp"
#include "engine/wind/wind_reading.hpp"
#include "engine/wire/wire.hpp"

namespace yuragi {

/// What has been counted of a sensor since the start.
struct SensorCounts {
  std::uint64_t readings = 0;
  std::array<std::uint64_t, kRefusalCount> refused{};  ///< by Refusal
  std::uint64_t not_believed = 0;                      ///< plausible readings that were kept from the wind
  std::uint64_t lost = 0;                              ///< readings that there was no room for
  std::uint64_t frames = 0;                            ///< messages from the device
  std::uint64_t reconnects = 0;
};

/// All that is known of a sensor at one moment. The texts are the caller's.
struct SensorFacts {
  std::string_view name;
  std::string_view driver;
  SensorEvidence evidence;
  std::optional<WindReading> last_raw{};  ///< before calibration
  SensorCounts counts{};
};

/// The same as the stream tells it. Pure.
wire::SensorStatus sensor_status(const SensorFacts& facts);

/// What the stream tells of the recording that is played while every sensor is silent: it counts as replayed once it
/// speaks. `report`: of its source; `readings`: since it began. Pure.
wire::SensorStatus fallback_status(std::string_view name, std::string_view driver, const LinkReport& link,
                                   const SourceReport& report, std::uint64_t readings);

}  // namespace yuragi
