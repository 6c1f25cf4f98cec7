#pragma once

#include <optional>
#include <string_view>
#include <variant>

#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi::drivers::windlog {

class Reader;

/// A place in a recording: log time, or UTC.
using LogMoment = std::variant<Nanoseconds, UtcTime>;

/// Parses one: seconds from the recording's first reading ("90", "12.5"), or a moment in ISO 8601
/// ("2018-07-20T14:05:00Z"; parse_iso_time). Empty is the beginning. The failure's
/// text: what is allowed.
Result<LogMoment, Failure> parse_log_moment(std::string_view text);

/// Returns its log time in one recording: for UTC that of the first reading at or after it, nullopt if there is none.
Result<std::optional<Nanoseconds>, Failure> log_time_of(Reader& reader, const LogMoment& moment);

}  // namespace yuragi::drivers::windlog
