#pragma once

#include <cstddef>
#include <istream>
#include <string>
#include <string_view>

#include <toml++/toml.h>

namespace yuragi::tables {

inline constexpr std::size_t kMaxToml_bytes = std::size_t{4} << 20;
/// Levels of nesting: each part of a header and of a key, and each array, is one.
inline constexpr std::size_t kMaxTomlLevels = 32;
inline constexpr std::size_t kMaxTomlKey_bytes = 1024;  ///< of a header or key, without spaces

/// Parses a TOML document; only this function calls toml++'s parser, which has no limits on keys and crashes on very
/// deep ones. The limits above are checked first, in linear time and without recursion. Throws toml::parse_error with
/// its place, also if a limit is exceeded. Thread-safe.
toml::table parse_toml(std::string_view text, std::string_view source_name = {});

/// Reads a document, but at most one byte beyond kMaxToml_bytes, for which parse_toml() refuses it. `in` is bad() after
/// a read error.
std::string toml_text(std::istream& in);

}  // namespace yuragi::tables
