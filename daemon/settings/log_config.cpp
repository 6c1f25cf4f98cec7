#include "daemon/settings/log_config.hpp"

#include <algorithm>

namespace yuragi::daemon::settings {

LogConfig log_config_of(const ParameterValues& values) {
  const auto found = std::ranges::find(kLogLevelNames, values.text("level"));
  return {.level = static_cast<LogLevel>(found - kLogLevelNames.begin())};
}

}  // namespace yuragi::daemon::settings
