#pragma once

#include <string>

#include "engine/wire/wire.hpp"

namespace yuragi::daemon::web {

/// The state of the daemon in the text format of Prometheus 0.0.4. Names have their unit at the end, in base units.
/// Pure.
std::string metrics_text(const wire::Sensors& sensors, const std::string& software);

}  // namespace yuragi::daemon::web
