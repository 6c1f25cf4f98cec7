#include "drivers/decode/text/gill.hpp"

#include <cmath>
#include <cstddef>

#include "drivers/decode/text/nmea.hpp"
#include "engine/base/units.hpp"

namespace yuragi::drivers::decode::text {
namespace {

using GillResult = Result<DecodedWind, Refusal>;

constexpr char kStx = '\x02';
constexpr char kEtx = '\x03';

std::optional<double> gill_unit(std::string_view letter) {
  constexpr double kMetresPerSecondPerFootPerMinute = 0.3048 / 60.0;
  if (letter == "P") return kMetresPerSecondPerMph;
  if (letter == "F") return kMetresPerSecondPerFootPerMinute;
  return metres_per_second_of(letter);
}

bool is_signed(std::string_view field) {
  return !field.empty() && (field.front() == '+' || field.front() == '-');
}

/// What stands between STX and ETX, its checksum proven.
Result<std::string_view, Refusal> gill_body_of(const GillOptions& options, std::string_view line) {
  line = trimmed(line);
  if (const std::size_t start = line.rfind(kStx); start != std::string_view::npos) line.remove_prefix(start + 1);
  if (line.empty()) return Refusal::kTooShort;

  const std::size_t end = line.find(kEtx);
  const std::string_view digits = end == std::string_view::npos ? std::string_view() : line.substr(end + 1);
  if (digits.empty()) {
    if (options.checksum == WhenMissing::kRefuse) return Refusal::kTooShort;
    return line.substr(0, end);
  }
  if (const auto refusal = xor_checksum_refusal(line.substr(0, end), digits)) return *refusal;
  return line.substr(0, end);
}

/// Two numbers as they stand in the fields behind the node, times `factor`: speed and direction, or components.
GillResult decode_gill_values(const GillOptions& options, const TextFields& fields, double factor, DecodedWind wind) {
  if (is_signed(fields[1]) || is_signed(fields[2])) {
    const auto u = parse_number(fields[1]);
    const auto v = parse_number(fields[2]);
    if (!u || !v) return Refusal::kMalformed;
    if (!*u || !*v) return Refusal::kInvalid;
    // Where it comes from is where -u (south) and +v (east) point; atan2 gives [-180, 180].
    wind.speed_m_s = std::hypot(**u, **v) * factor;
    const double from_deg = std::atan2(**v, -**u) / kRadPerDeg;
    wind.direction_deg = wrapped_direction_deg(from_deg < 0.0 ? from_deg + 360.0 : from_deg);
  } else {
    const auto direction_deg = parse_direction_deg(fields[1]);
    if (!direction_deg) return direction_deg.error();
    const auto speed = parse_number(fields[2]);
    if (!speed) return speed.error();
    wind.direction_deg = *direction_deg;
    if (*speed) wind.speed_m_s = **speed * factor;
  }

  if (wind.speed_m_s && *wind.speed_m_s < options.least_speed_with_direction_m_s) wind.direction_deg.reset();
  return checked(wind);
}

bool is_hexadecimal(std::string_view text) {
  return text.find_first_not_of("0123456789ABCDEFabcdef") == std::string_view::npos;
}

}  // namespace

GillResult decode_gill(const GillOptions& options, std::string_view line) noexcept {
  if (const auto text = trimmed(line); !text.empty() && text.front() == '$') {
    return decode_nmea({.checksum = options.checksum, .status = options.status, .xdr_first_id = 0}, text);
  }
  const auto body = gill_body_of(options, line);
  if (!body) return body.error();
  const TextFields fields = split_fields(*body, ',');

  const std::string_view node = fields[0];
  const bool is_gill = fields.count > 3 && node.size() == 1 && node[0] >= 'A' && node[0] <= 'Z';
  if (!is_gill || (options.node && node[0] != *options.node)) return Refusal::kNotMine;
  if (!fields.are_all) return Refusal::kMalformed;

  // The status is the last field; the comma behind it makes one more, which is empty.
  std::size_t last = fields.count - 1;
  if (fields[last].empty()) --last;
  const std::string_view status = fields[last];

  DecodedWind wind;
  wind.reference = WindReference::kRelative;
  if (const auto factor = gill_unit(fields[3])) {
    const bool has_status = last > 3 && !status.empty();
    if (has_status && !is_good_status(status)) return Refusal::kInvalid;
    if (!has_status) {
      if (options.status == WhenMissing::kRefuse) return Refusal::kMalformed;
      wind.status = DecodedStatus::kUncertain;
    }
    return decode_gill_values(options, fields, *factor, wind);
  }

  // MaxiMet: behind the speed comes another number, or nothing. Its status flags voltage and satellites too.
  const auto next = parse_number(fields[3]);
  if (!next) return Refusal::kMalformed;
  const bool has_flags = last > 3 && status.size() == 4 && is_hexadecimal(status);
  if (has_flags && status != "0000") wind.status = DecodedStatus::kUncertain;
  return decode_gill_values(options, fields, 1.0, wind);
}

}  // namespace yuragi::drivers::decode::text
