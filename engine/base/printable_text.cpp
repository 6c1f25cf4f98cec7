#include "engine/base/printable_text.hpp"

#include <algorithm>
#include <cstdint>

namespace yuragi {
namespace {

bool is_continuation(char byte) {
  return (static_cast<unsigned char>(byte) & 0xC0u) == 0x80u;
}

/// The length of the character that begins with this byte; 0: no character begins with it.
std::size_t announced_bytes(unsigned char first) {
  if (first < 0x80) return 1;
  if (first >= 0xC2 && first < 0xE0) return 2;
  if (first >= 0xE0 && first < 0xF0) return 3;
  if (first >= 0xF0 && first < 0xF5) return 4;
  return 0;
}

/// A character at the beginning of a text.
struct Character {
  std::size_t bytes = 0;  ///< 0: not UTF-8
  std::uint32_t code = 0;
};

Character first_character(std::string_view text) {
  constexpr std::uint32_t kMinCode[] = {0, 0, 0x80, 0x800, 0x10000};  // minimum code by the number of bytes
  const auto first = static_cast<unsigned char>(text.front());
  const std::size_t bytes = announced_bytes(first);
  if (bytes <= 1) return {bytes, first};
  if (bytes > text.size()) return {};
  std::uint32_t code = first & (0xFFu >> (bytes + 1));
  for (const char next : text.substr(1, bytes - 1)) {
    if (!is_continuation(next)) return {};
    code = (code << 6) | (static_cast<unsigned char>(next) & 0x3Fu);
  }
  const bool is_surrogate = code >= 0xD800 && code <= 0xDFFF;
  if (code < kMinCode[bytes] || code > 0x10FFFF || is_surrogate) return {};
  return {bytes, code};
}

bool is_printable_code(std::uint32_t code) {
  const bool is_control = code < 0x20 || (code >= 0x7F && code <= 0x9F);
  const bool is_format =
      code == 0x200E || code == 0x200F || (code >= 0x2028 && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069);
  return !is_control && !is_format;
}

}  // namespace

void make_printable(std::string& text) {
  for (std::size_t place = 0; place < text.size();) {
    const Character character = first_character(std::string_view(text).substr(place));
    const std::size_t bytes = std::max<std::size_t>(character.bytes, 1);
    if (character.bytes == 0 || !is_printable_code(character.code)) text.replace(place, bytes, bytes, '?');
    place += bytes;
  }
}

bool is_printable(std::string_view text) {
  std::string shown(text);
  make_printable(shown);
  return shown == text;
}

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t bytes = first_character(text).bytes;
    if (bytes == 0) return false;
    text.remove_prefix(bytes);
  }
  return true;
}

std::string shortened(std::string_view text, std::size_t characters) {
  std::size_t end = 0;
  for (; end < text.size(); ++end) {
    if (!is_continuation(text[end]) && characters-- == 0) break;
  }
  return std::string(text.substr(0, end)) + (end < text.size() ? "..." : "");
}

}  // namespace yuragi
