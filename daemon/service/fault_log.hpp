#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "daemon/stream/log_allowance.hpp"
#include "daemon/web/fault_counts.hpp"
#include "engine/base/time.hpp"

namespace yuragi::daemon::service {

/// Counts contained exceptions by their kind, and chooses which are logged: the first of each kind at once, then one
/// line a minute of that kind, with the number of those left out since the last line. Memory is bounded: beyond
/// kMaxKinds, further kinds are one, kOtherKind. Pure: time is a parameter. Thread-safe: no.
class FaultLog {
 public:
  static constexpr Nanoseconds kInterval = std::chrono::minutes(1);

  static constexpr std::size_t kMaxKinds = 64;
  static constexpr std::string_view kOtherKind = "another task";

  /// Counts an exception of `kind` with the text `what`. Returns the line to log for it, or nullopt.
  std::optional<std::string> line_for(std::string_view kind, std::string_view what, MonoTime now);

  web::FaultCounts counts() const;

 private:
  struct Kind {
    std::uint64_t count = 0;
    stream::LogAllowance allowance;
  };

  std::map<std::string, Kind, std::less<>> kinds_;
};

}  // namespace yuragi::daemon::service
