#pragma once

#include <cstdint>
#include <istream>
#include <memory>
#include <string_view>

namespace yuragi::daemon::tools::csv {

/// How the text of a file is written in bytes.
enum class Encoding : std::uint8_t { kUtf8, kUtf16Little, kUtf16Big, kShiftJis, kLatin1 };

std::string_view name_of(Encoding encoding);

/// The encoding of a text that begins with these bytes: by its byte order mark, by the zero bytes of UTF-16, as UTF-8
/// if it is valid, or else as Shift_JIS if all of it can be that and some of it can be no Latin-1. ASCII is UTF-8.
/// Thread-safe: yes.
Encoding encoding_of(std::string_view beginning);

/// The rest of `in` in UTF-8, from a file in the folder of temporary files that no name leads to. What cannot be
/// converted becomes '?'. Throws FailureError if such a file cannot be written. Thread-safe: with separate streams.
std::unique_ptr<std::istream> converted_to_utf8(std::istream& in, Encoding encoding);

}  // namespace yuragi::daemon::tools::csv
