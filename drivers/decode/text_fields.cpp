#include "drivers/decode/text_fields.hpp"

#include <algorithm>
#include <charconv>
#include <system_error>

#include "drivers/decode/decoded_wind.hpp"
#include "engine/base/units.hpp"

namespace yuragi::drivers::decode {
namespace {

constexpr std::string_view kBlanks(" \t\r\n\0", 5);

bool is_digit_or_dot(char c) {
  return (c >= '0' && c <= '9') || c == '.';
}

/// The value of a hexadecimal digit, or nullopt.
std::optional<unsigned> hex_digit(char c) {
  if (c >= '0' && c <= '9') return static_cast<unsigned>(c - '0');
  if (c >= 'A' && c <= 'F') return static_cast<unsigned>(c - 'A' + 10);
  if (c >= 'a' && c <= 'f') return static_cast<unsigned>(c - 'a' + 10);
  return {};
}

}  // namespace

std::string_view trimmed(std::string_view text) noexcept {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

TextFields split_fields(std::string_view text, char separator) noexcept {
  TextFields fields;
  while (true) {
    if (fields.count == kMaxTextFields) {
      fields.are_all = false;
      return fields;
    }
    const std::size_t end = text.find(separator);
    fields.values[fields.count++] = trimmed(text.substr(0, end));
    if (end == std::string_view::npos) return fields;
    text.remove_prefix(end + 1);
  }
}

Result<std::optional<double>, Refusal> parse_number(std::string_view field) noexcept {
  field = trimmed(field);
  if (field.empty()) return std::optional<double>();

  // Only digits and a point after the sign: from_chars would also accept "inf".
  std::string_view digits = field;
  if (digits.front() == '+' || digits.front() == '-') digits.remove_prefix(1);
  if (digits.empty() || !std::ranges::all_of(digits, is_digit_or_dot)) return Refusal::kMalformed;

  double number = 0.0;
  const char* const end = digits.data() + digits.size();
  const auto [stop, error] = std::from_chars(digits.data(), end, number, std::chars_format::fixed);
  if (error != std::errc() || stop != end) return Refusal::kMalformed;
  return std::optional(field.front() == '-' ? -number : number);
}

Result<std::optional<double>, Refusal> parse_direction_deg(std::string_view field) noexcept {
  const auto number = parse_number(field);
  if (!number || !*number) return number;
  const auto direction_deg = wrapped_direction_deg(**number);
  if (!direction_deg) return Refusal::kImplausible;
  return direction_deg;
}

std::uint8_t xor_checksum(std::string_view text) noexcept {
  unsigned sum = 0;
  for (const char c : text) sum ^= static_cast<unsigned char>(c);
  return static_cast<std::uint8_t>(sum);
}

std::optional<Refusal> xor_checksum_refusal(std::string_view text, std::string_view digits) noexcept {
  if (digits.size() < 2) return Refusal::kTooShort;
  if (digits.size() > 2) return Refusal::kMalformed;
  const auto high = hex_digit(digits[0]);
  const auto low = hex_digit(digits[1]);
  if (!high || !low || 16 * *high + *low != xor_checksum(text)) return Refusal::kBadChecksum;
  return {};
}

Result<std::string_view, Refusal> sentence_of(std::string_view line, WhenMissing checksum) noexcept {
  line = trimmed(line);
  if (line.empty()) return Refusal::kTooShort;
  const std::size_t start = line.front() == '#' ? std::string_view::npos : line.rfind('$');
  if (start == std::string_view::npos) return Refusal::kNotMine;
  line.remove_prefix(start + 1);

  const std::size_t star = line.rfind('*');
  const std::string_view body = line.substr(0, star);
  const bool is_missing = star == std::string_view::npos || line.substr(star + 1) == "//";
  if (is_missing) {
    if (checksum == WhenMissing::kRefuse) return Refusal::kBadChecksum;
    return body;
  }
  if (const auto refusal = xor_checksum_refusal(body, line.substr(star + 1))) return *refusal;
  return body;
}

std::optional<double> metres_per_second_of(std::string_view letter) noexcept {
  if (letter == "M") return 1.0;
  if (letter == "N") return kMetresPerSecondPerKnot;
  if (letter == "K") return kMetresPerSecondPerKmh;
  return {};
}

bool is_good_status(std::string_view status) noexcept {
  return status == "A" || status == "00" || status == "60";
}

}  // namespace yuragi::drivers::decode
