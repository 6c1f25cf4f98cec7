#pragma once

#include <string>

#include "daemon/history/wind_history.hpp"

namespace yuragi::daemon::history {

/// As JSON: for each sensor a row of each value, with null if nothing was recorded and a direction where there was a
/// wind. Invalid UTF-8 in names is replaced.
std::string history_json(const WindHistory& history);

}  // namespace yuragi::daemon::history
