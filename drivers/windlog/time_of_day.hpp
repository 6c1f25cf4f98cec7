#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string_view>

#include "drivers/windlog/windlog_reader.hpp"
#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi::drivers::windlog {

/// How far a place's clocks are ahead of UTC at a moment.
using UtcOffset = std::function<Nanoseconds(UtcTime)>;

/// That of this machine's time zone (/etc/localtime, or TZ), daylight saving included. Thread-safe: yes.
Nanoseconds machine_utc_offset(UtcTime moment);

/// Parses an offset: hours ahead of UTC, "1", "-3.5", "5.75", from -14 to 14. Empty: the machine's. The failure's text:
/// what is allowed.
Result<UtcOffset, Failure> parse_utc_offset(std::string_view text);

/// The time since the last local midnight, from 0 to a day.
Nanoseconds time_of_day(UtcTime moment, const UtcOffset& offset);

/// The first place of a recording, from `from` on, where its local clock showed `wanted`. If it never did, the
/// beginning (of a session, or `from`) whose time of day comes next after `wanted`; nullopt if there is no reading from
/// `from` on. Sessions of days and weeks are covered by their times of day alone, so the date does not matter. A
/// session's clock is taken as of its end: a machine without a battery learns the time only after its start.
std::optional<Nanoseconds> find_time_of_day(std::span<const LoggedSession> sessions, Nanoseconds from,
                                            Nanoseconds wanted, const UtcOffset& recorded);

}  // namespace yuragi::drivers::windlog
