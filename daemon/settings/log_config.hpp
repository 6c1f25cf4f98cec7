#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "engine/base/parameter.hpp"

namespace yuragi::daemon::settings {

/// How important a line of the log must be to be written: [log] level.
enum class LogLevel : std::uint8_t { kDebug, kInfo, kWarning, kError };
inline constexpr std::array<std::string_view, 4> kLogLevelNames = {"debug", "info", "warning", "error"};

/// [log]: what the daemon writes to standard error.
struct LogConfig {
  LogLevel level = LogLevel::kInfo;
};

/// From the values of log_parameters().
LogConfig log_config_of(const ParameterValues& values);

}  // namespace yuragi::daemon::settings
