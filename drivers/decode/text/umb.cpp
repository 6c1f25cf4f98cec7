#include "drivers/decode/text/umb.hpp"

#include <charconv>
#include <system_error>

#include "drivers/decode/text/nmea.hpp"

namespace yuragi::drivers::decode::text {
namespace {

/// Digits, five of them, up to 65535.
std::optional<std::uint16_t> five_digits(std::string_view field) {
  std::uint16_t number = 0;
  const char* const end = field.data() + field.size();
  const auto [stop, error] = std::from_chars(field.data(), end, number);
  if (field.size() != 5 || error != std::errc() || stop != end) return {};
  return number;
}

/// "$ 28673 M 00400 12345"
Result<DecodedWind, Refusal> decode_umb_ascii(const UmbOptions& options, std::string_view line) {
  constexpr double kFullScale = 65520.0;
  constexpr double kDirectionRange_deg = 359.9;
  constexpr std::uint16_t kSpeeds = 400;
  constexpr std::uint16_t kDirections = 500;
  constexpr std::uint16_t kGreatest = 40;

  const TextFields fields = split_fields(line, ' ');
  if (fields[2] != "M") return fields.count < 3 ? Refusal::kTooShort : Refusal::kNotMine;
  if (fields.count < 5 || fields[4].size() < 5) return Refusal::kTooShort;
  const auto device = five_digits(fields[1]);
  const auto channel = five_digits(fields[3]);
  const auto raw = five_digits(fields[4]);
  if (fields.count != 5 || !device || !channel || !raw) return Refusal::kMalformed;
  if (options.device && *device != *options.device) return Refusal::kNotMine;

  // Which quantity: the kind of value in steps of 20, the unit in steps of 5.
  const bool is_speed = *channel >= kSpeeds && *channel <= kSpeeds + 95 && *channel % 5 == 0;
  const bool is_direction = *channel >= kDirections && *channel <= kDirections + 80 && *channel % 20 == 0;
  if (!is_speed && !is_direction) return Refusal::kNotMine;
  if (*raw > kFullScale) return Refusal::kInvalid;

  DecodedWind wind;
  wind.reference = WindReference::kRelative;
  const double share = *raw / kFullScale;
  if (is_direction) {
    wind.direction_deg = share * kDirectionRange_deg;
  } else {
    const bool is_gust = (*channel - kSpeeds) / 20 == kGreatest / 20;
    (is_gust ? wind.gust_m_s : wind.speed_m_s) = share * options.speed_range_m_s;
  }
  return checked(wind);
}

}  // namespace

Result<DecodedWind, Refusal> decode_umb(const UmbOptions& options, std::string_view line) noexcept {
  const std::string_view text = trimmed(line);
  if (text.starts_with("$ ")) return decode_umb_ascii(options, text);
  return decode_nmea({.checksum = options.checksum, .status = options.status, .xdr_first_id = 0}, text);
}

}  // namespace yuragi::drivers::decode::text
