#pragma once

#include <bitset>
#include <cstddef>
#include <string>
#include <string_view>

#include "daemon/settings/local_clock.hpp"
#include "engine/base/parameter.hpp"
#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi::daemon::settings {

/// Weekly opening hours in the local time of a time zone, to the minute.
///
/// Written as rules with commas between them: "10:00-18:00" (every day), "Tue-Sun 10:00-18:00, Thu 18:00-21:00",
/// "Fri 20:00-02:00" (into the next day), "00:00-24:00". Open if any rule applies; days without a
/// rule are closed. Local time follows the zone's daylight saving time.
///
/// Thread-safe: reading, yes. Only the functions that return text allocate.
class OpeningHours {
 public:
  /// Open at all hours.
  OpeningHours() noexcept { open_.set(); }

  /// An empty text: open at all hours. `zone`: a name of the IANA database ("Europe/Berlin"); empty: this machine's
  /// own, or UTC if it has none. The error names "hours" or "zone".
  static Result<OpeningHours, ParameterError> parse(std::string_view hours, const std::string& zone);

  bool is_always_open() const noexcept { return open_.all(); }

  bool is_open(UtcTime now) const;

  /// The time zone: "Europe/Berlin"; "UTC" on a machine without one.
  std::string zone_name() const { return clock_.zone_name(); }

  /// The local time of the next change, for a person: "until 18:00", "until Tue 10:00" if that is more than a
  /// day away; empty if there is none.
  std::string until_text(UtcTime now) const;

 private:
  static constexpr std::size_t kMinutesPerWeek = std::size_t{7} * 24 * 60;

  std::size_t minute_of_week(UtcTime now) const;

  std::bitset<kMinutesPerWeek> open_;  ///< from Monday 00:00 on
  LocalClock clock_;
};

}  // namespace yuragi::daemon::settings
