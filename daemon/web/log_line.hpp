#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace yuragi::daemon::web {

struct LogLine {
  double time_s = 0.0;  ///< since 1970, UTC
  std::string level;    ///< "info", "warning"
  std::string text;
};

/// Gives the last lines of a log, at most this many, oldest first.
using LogTail = std::function<std::vector<LogLine>(std::size_t most)>;

}  // namespace yuragi::daemon::web
