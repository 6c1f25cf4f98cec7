#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace yuragi {

/// Makes any bytes valid UTF-8 that a terminal and a log can show: control characters (C0, DEL and C1), characters that
/// change the direction of text or break the line (U+200E, U+200F, U+2028 to U+202E, U+2066 to U+2069), and bytes that
/// are not UTF-8 (RFC 3629) are replaced by a question mark for each byte. The size does not change. Thread-safe: yes.
void make_printable(std::string& text);

/// Returns true if make_printable() changes nothing. Thread-safe: yes.
bool is_printable(std::string_view text);

/// Returns true if `text` is valid UTF-8 (RFC 3629), control characters included. Thread-safe: yes.
bool is_utf8(std::string_view text);

/// The first `characters` of `text` (UTF-8), followed by "..." if there are more. Thread-safe: yes.
std::string shortened(std::string_view text, std::size_t characters);

}  // namespace yuragi
