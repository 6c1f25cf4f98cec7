#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace date {
class time_zone;
}

namespace yuragi::daemon::tools::csv {

/// The zone of a file's times: an offset from UTC, or a place whose clocks change in spring and autumn. Thread-safe:
/// yes.
class Zone {
 public:
  Zone() = default;  ///< UTC

  /// "UTC", "+02:00", "UTC-7", "Europe/Berlin". Fails, with what is allowed, for anything else.
  static Result<Zone, Failure> parse(std::string_view text);

  /// When the clock showed this time. An hour that comes twice, at the change to winter time, is the first one, or the
  /// second if the first would not be after `last`. Nullopt for an hour that is skipped in spring.
  std::optional<UtcTime> to_utc(UtcTime clock, std::optional<UtcTime> last) const;

  const std::string& name() const { return name_; }

 private:
  const date::time_zone* zone_ = nullptr;  ///< null: `offset_`
  Nanoseconds offset_{0};
  std::string name_ = "UTC";
};

}  // namespace yuragi::daemon::tools::csv
