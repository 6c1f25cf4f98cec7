#pragma once

#include <string>

#include "daemon/web/fault_counts.hpp"
#include "daemon/web/web_counts.hpp"
#include "engine/wire/wire.hpp"

namespace yuragi::daemon::web {

/// The state of the daemon in the text format of Prometheus 0.0.4. Names have their unit at the end, in base units.
/// Pure.
std::string metrics_text(const wire::Sensors& sensors, const std::string& software, const Counts& counts = {},
                         const FaultCounts& faults = {});

}  // namespace yuragi::daemon::web
