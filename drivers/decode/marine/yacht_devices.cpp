#include "drivers/decode/marine/yacht_devices.hpp"

#include <array>
#include <charconv>
#include <optional>
#include <system_error>

#include "drivers/decode/text_fields.hpp"

namespace yuragi::drivers::decode::marine {
namespace {

constexpr std::size_t kTime = 0;
constexpr std::size_t kWay = 1;
constexpr std::size_t kIdentifier = 2;
constexpr std::size_t kData = 3;
constexpr std::size_t kMostBytes = 8;
constexpr std::string_view kTimeShape = "00:00:00.000";
constexpr std::uint32_t kLargestIdentifier = 0x1FFFFFFF;

bool is_time(std::string_view text) {
  if (text.size() != kTimeShape.size()) return false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool is_digit = text[i] >= '0' && text[i] <= '9';
    if (kTimeShape[i] == '0' ? !is_digit : text[i] != kTimeShape[i]) return false;
  }
  return true;
}

/// A hexadecimal number of so many digits.
std::optional<std::uint32_t> hex_number(std::string_view text, std::size_t digits) {
  if (text.size() != digits) return {};
  std::uint32_t number = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number, 16);
  if (error != std::errc() || stop != end) return {};
  return number;
}

/// Of the identifier: 3 bits of priority, 2 of data page, 8 of format, 8 that are part of the PGN where the format is
/// 240 or above and the destination's address otherwise, 8 of the sender's address.
std::uint32_t pgn_of(std::uint32_t identifier) {
  const std::uint32_t pgn = (identifier >> 8U) & 0x3FFFFU;
  const bool has_destination = ((pgn >> 8U) & 0xFFU) < 240U;
  return has_destination ? pgn & 0x3FF00U : pgn;
}

}  // namespace

bool looks_like_yacht_devices(std::string_view line) noexcept {
  const TextFields fields = split_fields(trimmed(line), ' ');
  return is_time(fields[kTime]) && (fields[kWay] == "R" || fields[kWay] == "T");
}

Result<BusWind, Refusal> decode_yacht_devices(std::string_view line) noexcept {
  const TextFields fields = split_fields(trimmed(line), ' ');
  if (fields.count <= kData) return Refusal::kTooShort;
  const auto identifier = hex_number(fields[kIdentifier], 8);
  if (!looks_like_yacht_devices(line) || !identifier || *identifier > kLargestIdentifier) return Refusal::kMalformed;
  if (fields.count > kData + kMostBytes) return Refusal::kMalformed;

  std::array<std::uint8_t, kMostBytes> data{};
  const std::size_t size = fields.count - kData;
  for (std::size_t i = 0; i < size; ++i) {
    const auto byte = hex_number(fields[kData + i], 2);
    if (!byte) return Refusal::kMalformed;
    data[i] = static_cast<std::uint8_t>(*byte);
  }
  if (fields[kWay] != "R" || pgn_of(*identifier) != kWindDataPgn) return Refusal::kNotMine;
  return decode_wind_data(static_cast<std::uint8_t>(*identifier & 0xFFU), ByteSpan(data).first(size));
}

}  // namespace yuragi::drivers::decode::marine
