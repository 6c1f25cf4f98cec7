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

/// The text between STX and ETX, with a valid checksum.
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
    const auto speed = parse_number(fields[2]);
    if (!speed) return speed.error();
    if (!direction_deg && !*speed) return direction_deg.error();
    if (direction_deg) {
      wind.direction_deg = *direction_deg;
    } else {
      wind.status = DecodedStatus::kUncertain;  // the speed is still one
    }
    if (*speed) wind.speed_m_s = **speed * factor;
  }

  if (wind.speed_m_s && *wind.speed_m_s < options.least_speed_with_direction_m_s) wind.direction_deg.reset();
  return checked(wind);
}

bool is_hexadecimal(std::string_view text) {
  return text.find_first_not_of("0123456789ABCDEFabcdef") == std::string_view::npos;
}

/// A message with a unit, or a MaxiMet's, which has none.
struct GillMessage {
  TextFields fields;
  std::size_t last = 0;            ///< the last field that is not empty
  std::size_t unit_at = 0;         ///< 4 behind a vertical wind; 0: there is no unit
  double metres_per_second = 1.0;  ///< of the unit
  std::string_view status;

  bool has_vertical() const { return unit_at == 4; }
};

/// A WindMaster's is the first field of two hexadecimal digits behind the unit; numbers there have a sign or a point.
std::string_view gill_status_of(const GillMessage& message) {
  if (!message.has_vertical()) return message.fields[message.last];
  for (std::size_t at = message.unit_at + 1; at <= message.last; ++at) {
    if (message.fields[at].size() == 2 && is_hexadecimal(message.fields[at])) return message.fields[at];
  }
  return {};
}

Result<GillMessage, Refusal> gill_message_of(const GillOptions& options, std::string_view line) {
  const auto body = gill_body_of(options, line);
  if (!body) return body.error();
  GillMessage message;
  message.fields = split_fields(*body, ',');
  const TextFields& fields = message.fields;

  const std::string_view node = fields[0];
  const bool is_gill = fields.count > 3 && node.size() == 1 && node[0] >= 'A' && node[0] <= 'Z';
  if (!is_gill || (options.node && node[0] != *options.node)) return Refusal::kNotMine;
  if (!fields.are_all) return Refusal::kMalformed;

  // The status is the last field, except in a WindMaster's line; the comma behind it makes one more, which is empty.
  message.last = fields.count - 1;
  if (fields[message.last].empty()) --message.last;
  for (const std::size_t at : {std::size_t{3}, std::size_t{4}}) {
    if (const auto factor = gill_unit(fields[at])) {
      message.unit_at = at;
      message.metres_per_second = *factor;
      break;
    }
  }
  message.status = gill_status_of(message);
  return message;
}

/// Why a message with a unit is not to be used, by its status.
std::optional<Refusal> gill_status_refusal(const GillOptions& options, const GillMessage& message) {
  const bool has_status = message.last > message.unit_at && !message.status.empty();
  if (has_status) return is_good_status(message.status) ? std::nullopt : std::optional(Refusal::kInvalid);
  return options.status == WhenMissing::kRefuse ? std::optional(Refusal::kMalformed) : std::nullopt;
}

}  // namespace

GillResult decode_gill(const GillOptions& options, std::string_view line) noexcept {
  if (const auto text = trimmed(line); !text.empty() && text.front() == '$') {
    return decode_nmea({.checksum = options.checksum, .status = options.status, .xdr_first_id = 0}, text);
  }
  const auto message = gill_message_of(options, line);
  if (!message) return message.error();
  const TextFields& fields = message->fields;

  DecodedWind wind;
  wind.reference = WindReference::kRelative;
  if (message->unit_at > 0) {
    if (const auto refusal = gill_status_refusal(options, *message)) return *refusal;
    const bool has_status = message->last > message->unit_at && !message->status.empty();
    if (!has_status) wind.status = DecodedStatus::kUncertain;
    return decode_gill_values(options, fields, message->metres_per_second, wind);
  }

  // MaxiMet: behind the speed comes another number, or nothing. Its status flags voltage and satellites too.
  const auto next = parse_number(fields[3]);
  if (!next) return Refusal::kMalformed;
  const bool has_flags = message->last > 3 && message->status.size() == 4 && is_hexadecimal(message->status);
  if (has_flags && message->status != "0000") wind.status = DecodedStatus::kUncertain;
  return decode_gill_values(options, fields, 1.0, wind);
}

std::optional<wind::StationQuantities> decode_gill_quantities(const GillOptions& options,
                                                              std::string_view line) noexcept {
  const auto message = gill_message_of(options, line);
  if (!message || !message->has_vertical() || gill_status_refusal(options, *message)) return std::nullopt;
  const auto vertical = parse_number(message->fields[3]);
  if (!vertical || !*vertical) return std::nullopt;
  wind::StationQuantities said;
  said.vertical_speed_m_s = **vertical * message->metres_per_second;
  return said;
}

}  // namespace yuragi::drivers::decode::text
