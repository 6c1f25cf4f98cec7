#include "daemon/feeds/osc_addresses.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace yuragi::daemon::feeds {
namespace {

bool is_kept(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
}

/// A further byte of a character of UTF-8.
bool is_continuation(char c) {
  return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
}

}  // namespace

std::string osc_part_of(std::string_view name) {
  std::string part;
  for (const char c : name) {
    if (!is_continuation(c)) part += is_kept(c) ? c : '_';
  }
  return part;
}

std::vector<std::string> osc_parts_of(const std::vector<std::string>& names) {
  std::vector<std::string> parts;
  for (const std::string& name : names) {
    const std::string plain = osc_part_of(name);
    std::string part = plain;
    for (int number = 2; std::ranges::count(parts, part) > 0; ++number) part = fmt::format("{}_{}", plain, number);
    parts.push_back(std::move(part));
  }
  return parts;
}

}  // namespace yuragi::daemon::feeds
