#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "daemon/sensing/sensor_diagnosis.hpp"
#include "daemon/sensing/sensor_runner.hpp"
#include "drivers/sensor/sensor.hpp"
#include "engine/wind/wind_reading.hpp"
#include "engine/wire/wire.hpp"

namespace yuragi::daemon::sensing {

/// The counts of a sensor since the start.
struct SensorCounts {
  std::uint64_t readings = 0;
  std::array<std::uint64_t, drivers::decode::kRefusalCount> refused{};  ///< by Refusal
  std::uint64_t not_believed = 0;  ///< plausible readings that were left out of the wind
  std::uint64_t lost = 0;          ///< readings dropped for lack of room
  std::uint64_t frames = 0;        ///< messages from the device
  std::uint64_t reconnects = 0;
};

/// Everything that the status of a sensor is made of. The texts must outlive it.
struct SensorFacts {
  std::string_view name;
  std::string_view driver;
  SensorEvidence evidence;
  std::string value{};                      ///< what its speed is, with the source, for a person
  std::optional<wind::Reading> last_raw{};  ///< before calibration
  SensorCounts counts{};
  std::vector<wire::QuantityStatus> quantities{};
};

/// The same as a message of the stream. Pure.
wire::SensorStatus sensor_status(const SensorFacts& facts);

/// The status of the fall-back recording: replayed once it is live, connecting before. `report`: of its source;
/// `readings`: since it began. Pure.
wire::SensorStatus fallback_status(std::string_view name, std::string_view driver, const LinkReport& link,
                                   const wind::SourceReport& report, std::uint64_t readings);

}  // namespace yuragi::daemon::sensing
