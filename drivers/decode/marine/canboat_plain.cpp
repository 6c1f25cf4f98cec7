#include "drivers/decode/marine/canboat_plain.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <system_error>

#include "drivers/decode/marine/bus_frame.hpp"
#include "drivers/decode/text_fields.hpp"

namespace yuragi::drivers::decode::marine {
namespace {

constexpr std::string_view kPlainDateShape = "0000-00-00";
constexpr std::string_view kPlainClockShape = "00:00:00";
constexpr std::string_view kPlainTimeMarks = "T-Zt_ ";  // between date and time of day
constexpr std::uint32_t kMaxPlainPriority = 7;
constexpr std::uint32_t kMaxPlainPgn = 0x7FFFF;  // from 0x40000 on: of an Actisense NGT-1 about itself
constexpr std::uint32_t kMaxPlainAddress = 255;
constexpr std::uint32_t kMaxPlainBytes = 1785;  // ISO 11783 transport; a fast packet has at most 223

/// The numbers before the bytes, by their places.
enum PlainNumber : std::uint8_t { kPlainPriority, kPlainPgn, kPlainSource, kPlainDestination, kPlainSize };
constexpr std::array<std::uint32_t, 5> kMaxPlainNumbers = {kMaxPlainPriority, kMaxPlainPgn, kMaxPlainAddress,
                                                           kMaxPlainAddress, kMaxPlainBytes};

bool is_plain_digit(char c) {
  return c >= '0' && c <= '9';
}

/// Removes a text of this shape, in which 0 stands for any digit, from the front.
bool take_shape(std::string_view& text, std::string_view shape) {
  if (text.size() < shape.size()) return false;
  for (std::size_t i = 0; i < shape.size(); ++i) {
    if (shape[i] == '0' ? !is_plain_digit(text[i]) : text[i] != shape[i]) return false;
  }
  text.remove_prefix(shape.size());
  return true;
}

/// "2018-02-14T15:55:07.944Z", "2013-05-05-10:11:12.123"; fraction and zone may be missing.
bool is_plain_time(std::string_view text) {
  if (!take_shape(text, kPlainDateShape)) return false;
  if (text.empty() || kPlainTimeMarks.find(text.front()) == kPlainTimeMarks.npos) return false;
  text.remove_prefix(1);
  if (!take_shape(text, kPlainClockShape)) return false;
  if (text.starts_with('.')) {
    text.remove_prefix(1);
    const auto digits = static_cast<std::size_t>(std::ranges::find_if_not(text, is_plain_digit) - text.begin());
    if (digits == 0) return false;
    text.remove_prefix(digits);
  }
  if (text.empty() || text == "Z" || text == "z") return true;
  if (text.front() != '+' && text.front() != '-') return false;
  text.remove_prefix(1);
  return take_shape(text, text.size() == 5 ? "00:00" : "0000") && text.empty();
}

/// Removes the next field from the front; an empty rest means that there are no more.
std::string_view take_field(std::string_view& rest) {
  const std::size_t end = rest.find(',');
  const std::string_view field = trimmed(rest.substr(0, end));
  rest.remove_prefix(end == rest.npos ? rest.size() : end + 1);
  return field;
}

std::optional<std::uint32_t> plain_number(std::string_view text, std::uint32_t max) {
  std::uint32_t number = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || stop != end || number > max) return {};
  return number;
}

}  // namespace

bool looks_like_canboat_plain(std::string_view line) noexcept {
  line = trimmed(line);
  return take_shape(line, kPlainDateShape);
}

std::string_view canboat_plain_time(std::string_view line) noexcept {
  line = trimmed(line);
  const std::string_view time = take_field(line);
  return is_plain_time(time) ? time : std::string_view();
}

Result<BusWind, Refusal> decode_canboat_plain(std::string_view line) noexcept {
  std::string_view rest = trimmed(line);
  if (std::ranges::count(rest, ',') <= static_cast<std::ptrdiff_t>(kMaxPlainNumbers.size())) return Refusal::kTooShort;
  if (!is_plain_time(take_field(rest))) return Refusal::kMalformed;
  std::array<std::uint32_t, kMaxPlainNumbers.size()> numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto number = plain_number(take_field(rest), kMaxPlainNumbers[i]);
    if (!number) return Refusal::kMalformed;
    numbers[i] = *number;
  }
  if (numbers[kPlainPgn] != kWindDataPgn) return Refusal::kNotMine;

  std::array<std::uint8_t, 8> data{};
  const std::size_t size = numbers[kPlainSize];
  if (size > data.size()) return Refusal::kMalformed;
  for (std::size_t i = 0; i < size; ++i) {
    if (trimmed(rest).empty()) return Refusal::kTooShort;
    const auto byte = hex_number(take_field(rest), 2);
    if (!byte) return Refusal::kMalformed;
    data[i] = static_cast<std::uint8_t>(*byte);
  }
  if (!trimmed(rest).empty()) return Refusal::kMalformed;
  return decode_wind_data(static_cast<std::uint8_t>(numbers[kPlainSource]), ByteSpan(data).first(size));
}

}  // namespace yuragi::drivers::decode::marine
