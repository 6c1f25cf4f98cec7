#include "daemon/tools/decode/hex_text.hpp"

#include <charconv>
#include <iterator>

#include <fmt/format.h>

namespace yuragi::daemon::tools::decode {

std::optional<std::vector<std::uint8_t>> parse_hex(std::string_view text) {
  constexpr std::string_view kBetweenBytes = " \t,:-";
  std::vector<std::uint8_t> bytes;
  while (true) {
    const auto begin = text.find_first_not_of(kBetweenBytes);
    if (begin == std::string_view::npos) return bytes;
    text.remove_prefix(begin);
    if (text.starts_with("0x") || text.starts_with("0X")) text.remove_prefix(2);

    const std::string_view digits = text.substr(0, 2);
    std::uint8_t byte = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), byte, 16);
    if (error != std::errc() || end != digits.data() + 2) return std::nullopt;
    bytes.push_back(byte);
    text.remove_prefix(2);
  }
}

std::string to_hex(std::span<const std::uint8_t> bytes) {
  std::string text;
  text.reserve(3 * bytes.size());
  for (const std::uint8_t byte : bytes) {
    fmt::format_to(std::back_inserter(text), "{}{:02x}", text.empty() ? "" : " ", byte);
  }
  return text;
}

std::string to_printable(std::span<const std::uint8_t> bytes) {
  std::string text;
  text.reserve(bytes.size());
  for (const std::uint8_t byte : bytes) text += byte >= 0x20 && byte < 0x7F ? static_cast<char>(byte) : '.';
  return text;
}

}  // namespace yuragi::daemon::tools::decode
