#pragma once

#include <cstdint>

#include "daemon/sensing/sensor_runner.hpp"
#include "daemon/settings/config.hpp"
#include "engine/wind/source_report.hpp"
#include "engine/wire/wire.hpp"

namespace yuragi {

/// What the stream is told of a sensor by its configuration, its link and what it said last. Its state and what is
/// counted are the caller's to add.
wire::SensorStatus status_of(const SensorConfig& sensor, const LinkReport& link, const SourceReport& said);

/// Adds what a sensor's thread has counted, and the readings that were not believed.
void add_counts(wire::SensorStatus& status, const SensorRunner& runner, std::uint64_t not_believed);

}  // namespace yuragi
