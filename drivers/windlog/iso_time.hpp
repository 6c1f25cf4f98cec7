#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "engine/base/time.hpp"

namespace yuragi::drivers::windlog {

/// A moment as people and loggers write it, in ISO 8601 and near it: 2018-07-20T14:00:00.1Z, with or without T, clock,
/// seconds, fraction (after a point or a comma; digits beyond nanoseconds are cut off) and zone (Z, +02:00, +0200, +02;
/// UTC if it names none), and with slashes in the date. A leap second is the first of the next minute. Nullopt if the
/// text is something else, or a moment that no recording can hold. Thread-safe: yes.
std::optional<UtcTime> parse_iso_time(std::string_view text);

/// 2018-07-20T14:00:00Z; fractions of a second are cut off. Thread-safe: yes.
std::string iso_time_text(UtcTime moment);

}  // namespace yuragi::drivers::windlog
