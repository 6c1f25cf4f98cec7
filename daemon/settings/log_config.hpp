#pragma once

#include <cstdint>

#include "engine/base/fields.hpp"

namespace yuragi::daemon::settings {

/// How important a line of the log must be to be written: [log] level.
enum class LogLevel : std::uint8_t { kDebug, kInfo, kWarning, kError };

/// [log]: what the daemon writes to standard error.
struct LogConfig {
  LogLevel level = LogLevel::kInfo;
};

const Fields<LogConfig>& log_fields();

}  // namespace yuragi::daemon::settings
