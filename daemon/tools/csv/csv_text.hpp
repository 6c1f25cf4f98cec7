#pragma once

#include <cstdio>
#include <optional>
#include <string>
#include <string_view>

#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi::daemon::tools::csv {

// Fields of a row, appended to a text that is written in one piece.

/// UTC in ISO 8601, to the nanosecond.
void append_utc(std::string& text, UtcTime time);

/// Seconds with nine decimals.
void append_log_time(std::string& text, Nanoseconds log_time);

/// A text, quoted where necessary. Line ends are replaced.
void append_text(std::string& text, std::string_view field);

/// With as many digits as give the same number when read; empty for nullopt.
void append_number(std::string& text, const std::optional<double>& number);

/// As much of a file is put together before it is written.
inline constexpr std::size_t kCsvBufferBytes = 1 << 16;

/// Writes the text out at once, and clears it, written or not.
Result<void, Failure> write_out(std::string& text, std::FILE* out);

}  // namespace yuragi::daemon::tools::csv
