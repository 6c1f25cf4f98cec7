#pragma once

#include <string>
#include <string_view>

#include "engine/base/result.hpp"

namespace yuragi {

/// Seconds of a duration as a person writes it: "90" and "90s" are seconds; "500ms", "5min", "1.5h", "2d". Never below
/// 0, and finite. The failure states what is allowed.
Result<double, Failure> parse_duration_s(std::string_view text);

/// Replaces such a text by its number of seconds, for a command line's parser. Returns the error, or an empty text.
std::string duration_to_seconds(std::string& text);

}  // namespace yuragi
