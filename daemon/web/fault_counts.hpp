#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>

namespace yuragi::daemon::web {

/// How many exceptions contain() has stopped since the program began, by what was being done.
using FaultCounts = std::map<std::string, std::uint64_t, std::less<>>;

/// Returns the counts of now. Thread-safe.
using FaultCounter = std::function<FaultCounts()>;

}  // namespace yuragi::daemon::web
