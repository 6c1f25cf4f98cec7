#pragma once

#include <cstddef>
#include <string_view>

namespace yuragi::drivers::decode {

/// Returns true for a JSON pointer (RFC 6901): empty, or a slash before each name, with "~" only in "~0" and "~1".
/// Thread-safe and realtime-safe: yes.
constexpr bool is_json_pointer(std::string_view text) noexcept {
  if (text.empty()) return true;
  if (text.front() != '/') return false;
  for (std::size_t at = text.find('~'); at != std::string_view::npos; at = text.find('~', at + 1)) {
    if (at + 1 == text.size() || (text[at + 1] != '0' && text[at + 1] != '1')) return false;
  }
  return true;
}

}  // namespace yuragi::drivers::decode
