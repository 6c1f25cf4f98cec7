#pragma once

#include <string>
#include <string_view>

#include "daemon/settings/duration_text.hpp"
#include "engine/base/time.hpp"

namespace yuragi::daemon::tools::report {

/// Text from outside, escaped for HTML or SVG, between tags or in a quoted attribute: without special characters, valid
/// UTF-8 (invalid bytes and control characters become U+FFFD), and truncated when very long.
std::string page_text(std::string_view text);

/// "2018-07-20 14:00:00 UTC".
std::string utc_text(UtcTime moment);

/// "2018-07-20 16:00:00 CEST", in the zone of this machine (TZ).
std::string local_text(UtcTime moment);

/// Local time minus UTC, in the zone of this machine. Reads no clock. Thread-safe: yes, unless TZ is changed.
Nanoseconds local_offset(UtcTime moment);

/// The nearest point of the compass in words: "north-north-east".
std::string compass_text(double direction_deg);

}  // namespace yuragi::daemon::tools::report
