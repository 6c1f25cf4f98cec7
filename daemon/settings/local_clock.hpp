#pragma once

#include <chrono>
#include <string>

#include "engine/base/parameter.hpp"
#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace date {
class time_zone;
}

namespace yuragi::daemon::settings {

/// The local time of a time zone, with its daylight saving time. Thread-safe: reading, yes.
class LocalClock {
 public:
  /// That of UTC.
  LocalClock() noexcept = default;

  /// `name`: of the IANA database ("Europe/Berlin"); empty: this machine's own zone, or UTC if it has none. The
  /// error names "zone".
  static Result<LocalClock, ParameterError> of_zone(const std::string& name);

  /// Local time since midnight, 1 January 1970, as if the clocks had run since then.
  std::chrono::seconds since_1970(UtcTime now) const;

  /// 0 to 24, less than that.
  double hour_of_day(UtcTime now) const;

  /// "Europe/Berlin"; "UTC" on a machine without a zone.
  std::string zone_name() const;

 private:
  const date::time_zone* zone_ = nullptr;  ///< null: UTC; lives as long as the program
};

}  // namespace yuragi::daemon::settings
