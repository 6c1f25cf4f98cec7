#include "drivers/decode/text/wxt.hpp"

#include <array>
#include <cstdint>
#include <span>

#include "engine/base/units.hpp"

namespace yuragi::drivers::decode::text {
namespace {

constexpr std::size_t kWxtHead = 3;  // address, R, number
constexpr std::size_t kWxtCrc = 3;   // characters

/// A field of a message: whether it is present, and its value in our unit if the device marks it as valid.
struct WxtField {
  bool is_there = false;
  std::optional<double> value;
};

/// A letter behind a number, and what it means: value * scale + offset is in our unit.
struct WxtUnit {
  char letter;
  double scale;
  double offset = 0.0;
};

constexpr std::array<WxtUnit, 1> kWxtDegrees = {{{'D', 1.0}}};
constexpr std::array<WxtUnit, 4> kWxtSpeeds = {
    {{'M', 1.0}, {'K', kMetresPerSecondPerKmh}, {'S', kMetresPerSecondPerMph}, {'N', kMetresPerSecondPerKnot}}};
constexpr std::array<WxtUnit, 2> kWxtTemperatures = {{{'C', 1.0}, {'F', 5.0 / 9.0, -160.0 / 9.0}}};
constexpr std::array<WxtUnit, 1> kWxtHumidities = {{{'P', 1.0}}};
constexpr std::array<WxtUnit, 5> kWxtPressures = {
    {{'H', 1.0}, {'P', 0.01}, {'B', 1000.0}, {'M', 1.33322387415}, {'I', 33.8638864}}};
constexpr std::array<WxtUnit, 2> kWxtRain = {{{'M', 1.0}, {'I', 25.4}}};

bool is_letter(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

std::uint16_t crc_16(std::string_view text) {
  std::uint16_t crc = 0;
  for (const char c : text) {
    crc = static_cast<std::uint16_t>(crc ^ static_cast<std::uint8_t>(c));
    for (int bit = 0; bit < 8; ++bit) {
      const bool carries = (crc & 1U) != 0;
      crc = static_cast<std::uint16_t>(crc >> 1U);
      if (carries) crc ^= 0xA001U;
    }
  }
  return crc;
}

std::array<char, kWxtCrc> wxt_crc(std::string_view text) {
  const unsigned crc = crc_16(text);
  return {static_cast<char>(0x40U | (crc >> 12U)), static_cast<char>(0x40U | ((crc >> 6U) & 0x3FU)),
          static_cast<char>(0x40U | (crc & 0x3FU))};
}

/// "0R1", "ar0", "0R": an address, R and perhaps the number of the message.
bool is_wxt_head(std::string_view head) {
  if (head.size() != kWxtHead && head.size() != kWxtHead - 1) return false;
  const bool has_number = head.size() == kWxtHead;
  return (is_letter(head[0]) || is_digit(head[0])) && (head[1] == 'R' || head[1] == 'r') &&
         (!has_number || is_digit(head[2]));
}

/// The fields of a data message behind its head, its checksum proven.
Result<TextFields, Refusal> wxt_fields(const WxtOptions& options, std::string_view line) {
  line = trimmed(line);
  if (line.empty()) return Refusal::kTooShort;
  const std::size_t comma = line.find(',');
  const std::string_view head = line.substr(0, comma);
  if (!is_wxt_head(head)) return Refusal::kNotMine;
  if (comma == std::string_view::npos) return Refusal::kTooShort;

  std::string_view body = line.substr(comma + 1);
  if (head[1] == 'r') {
    if (body.size() < kWxtCrc) return Refusal::kTooShort;
    const std::size_t crc_at = line.size() - kWxtCrc;
    const auto crc = wxt_crc(line.substr(0, crc_at));
    if (line.substr(crc_at) != std::string_view(crc.data(), crc.size())) return Refusal::kBadChecksum;
    body.remove_suffix(kWxtCrc);
  } else if (options.checksum == WhenMissing::kRefuse) {
    return Refusal::kBadChecksum;
  }
  const TextFields fields = split_fields(body, ',');
  if (!fields.are_all) return Refusal::kMalformed;
  for (std::size_t i = 0; i < fields.count; ++i) {
    const std::string_view field = fields[i];
    if (field.size() < 4 || !is_letter(field[0]) || !is_letter(field[1]) || field[2] != '=') return Refusal::kMalformed;
    for (std::size_t before = 0; before < i; ++before) {
      if (fields[before].substr(0, 2) == field.substr(0, 2)) return Refusal::kMalformed;
    }
  }
  return fields;
}

/// The field of that name, or kMalformed.
Result<WxtField, Refusal> wxt_field(const TextFields& fields, std::string_view name, std::span<const WxtUnit> units) {
  for (std::size_t i = 0; i < fields.count; ++i) {
    if (fields[i].substr(0, 2) != name) continue;
    const char letter = fields[i].back();
    const auto number = parse_number(fields[i].substr(3, fields[i].size() - 4));
    if (!number || !*number) return Refusal::kMalformed;
    if (letter == '#') return WxtField{.is_there = true, .value = {}};
    for (const WxtUnit& unit : units) {
      if (unit.letter == letter) return WxtField{.is_there = true, .value = **number * unit.scale + unit.offset};
    }
    return Refusal::kMalformed;
  }
  return WxtField{};
}

}  // namespace

bool looks_like_wxt(std::string_view line) noexcept {
  line = trimmed(line);
  const std::size_t comma = line.find(',');
  return comma != std::string_view::npos && is_wxt_head(line.substr(0, comma)) && line.find('=') == comma + 3;
}

Result<DecodedWind, Refusal> decode_wxt(const WxtOptions& options, std::string_view line) noexcept {
  const auto fields = wxt_fields(options, line);
  if (!fields) return fields.error();
  const auto speed = wxt_field(*fields, "Sm", kWxtSpeeds);
  const auto gust = wxt_field(*fields, "Sx", kWxtSpeeds);
  const auto direction = wxt_field(*fields, "Dm", kWxtDegrees);
  if (!speed || !gust || (!direction && !speed->value)) return Refusal::kMalformed;
  if (!speed->is_there && !gust->is_there && !direction->is_there) return Refusal::kNotMine;
  if (!speed->value) return Refusal::kInvalid;

  DecodedWind wind;
  wind.reference = WindReference::kRelative;
  wind.speed_m_s = speed->value;
  wind.gust_m_s = gust->value;
  if (direction && direction->value) wind.direction_deg = wrapped_direction_deg(*direction->value);
  const bool is_missing = direction && !direction->value;
  if (!is_missing && !wind.direction_deg) wind.status = DecodedStatus::kUncertain;  // the speed is still one
  return checked(wind);
}

std::optional<wind::StationQuantities> decode_wxt_quantities(const WxtOptions& options,
                                                             std::string_view line) noexcept {
  const auto fields = wxt_fields(options, line);
  if (!fields) return std::nullopt;
  const auto value_of = [&](std::string_view name, std::span<const WxtUnit> units) {
    const auto field = wxt_field(*fields, name, units);
    return field ? field->value : std::nullopt;
  };
  wind::StationQuantities said;
  said.air_temperature_c = value_of("Ta", kWxtTemperatures);
  said.relative_humidity_percent = value_of("Ua", kWxtHumidities);
  said.pressure_hpa = value_of("Pa", kWxtPressures);
  said.rain_total_mm = value_of("Rc", kWxtRain);
  said.rain_rate_mm_h = value_of("Ri", kWxtRain);
  for (const wind::StationQuantity& each : wind::kStationQuantities) {
    if (said.*each.value) return said;
  }
  return std::nullopt;
}

std::string wxt_wind_request(char address) {
  std::string request = {address, 'r', '1'};
  for (const char c : wxt_crc(request)) request += c;
  return request + "\r\n";
}

}  // namespace yuragi::drivers::decode::text
