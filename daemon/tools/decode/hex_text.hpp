#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace yuragi::daemon::tools::decode {

/// Parses bytes in hexadecimal digits, as dumps and manuals print them: two digits a byte, of
/// either case, with or without "0x" in front, and with blanks, tabs, commas, colons or hyphens between bytes. Empty
/// for an empty text; nullopt for anything else.
std::optional<std::vector<std::uint8_t>> parse_hex(std::string_view text);

/// "d4 36 0e"
std::string to_hex(std::span<const std::uint8_t> bytes);

/// The text column of a hex dump: printable ASCII as it is, every other byte as a dot.
std::string to_printable(std::span<const std::uint8_t> bytes);

}  // namespace yuragi::daemon::tools::decode
