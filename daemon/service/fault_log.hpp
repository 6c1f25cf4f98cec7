#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "daemon/stream/log_allowance.hpp"
#include "engine/base/time.hpp"

namespace yuragi::daemon::service {

/// Which contained exceptions are logged: the first of each kind at once, then one line a minute of that kind, with the
/// number of those left out since the last line. Pure: time is a parameter. Thread-safe: no.
class FaultLog {
 public:
  static constexpr Nanoseconds kInterval = std::chrono::minutes(1);

  /// Returns the line to log for an exception of `kind` with the text `what`, or nullopt.
  std::optional<std::string> line_for(std::string_view kind, std::string_view what, MonoTime now);

 private:
  std::map<std::string, stream::LogAllowance, std::less<>> allowances_;
};

}  // namespace yuragi::daemon::service
