#include "drivers/decode/network/station_push.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <optional>

#include "drivers/decode/text_fields.hpp"
#include "engine/base/secret.hpp"
#include "engine/base/units.hpp"

namespace yuragi::drivers::decode::network {
namespace {

/// The stations' mark for "no value".
constexpr double kNoPushValue = -9999.0;
constexpr double kHectopascalsPerInchOfMercury = 33.86389;
constexpr double kMillimetresPerInch = 25.4;
constexpr std::size_t kMaxPushText = 40;

/// The values that are read, by their places in kPushNames.
enum PushName : std::uint8_t {
  kPushPasskey,
  kPushId,
  kPushStationType,
  kPushSoftwareType,
  kPushSpeed,
  kPushGust,
  kPushDirection,
  kPushTemperature,
  kPushHumidity,
  kPushPressure,
  kPushWuPressure,
  kPushWuSeaLevelPressure,
  kPushSeaLevelPressure,
  kPushRainTotal,
  kPushRainOfYear,
  kPushPiezoRainOfYear,
  kPushRainOfDay,
  kPushPiezoRainOfDay,
  kPushRainRate,
  kPushPiezoRainRate,
  kLinkId,
  kLinkSpeed,
  kLinkGust,
  kLinkDirection,
  kLinkTemperature,
  kLinkHumidity,
  kLinkPressure,
  kLinkSeaLevelPressure,
  kLinkRainOfYear,
  kLinkRainRate,
  kLinkIsReceived,
};
constexpr std::array<std::string_view, 31> kPushNames = {
    "PASSKEY",      "ID",          "stationtype", "softwaretype", "windspeedmph", "windgustmph", "winddir",
    "tempf",        "humidity",    "baromabsin",  "absbaromin",   "baromin",      "baromrelin",  "totalrainin",
    "yearlyrainin", "yrain_piezo", "dailyrainin", "drain_piezo",  "rainratein",   "rrain_piezo", "wsid",
    "t1ws",         "t1wgust",     "t1wdir",      "t1tem",        "t1hum",        "abar",        "rbar",
    "t1rainyr",     "t1rainra",    "t1cn"};

/// The names and the unit of the wind in a form.
struct PushedWindNames {
  PushName speed;
  PushName gust;
  PushName direction;
  double unit_m_s;
};
constexpr PushedWindNames kPushedWind = {kPushSpeed, kPushGust, kPushDirection, kMetresPerSecondPerMph};
constexpr PushedWindNames kLinkWind = {kLinkSpeed, kLinkGust, kLinkDirection, 1.0};

/// Calls `take` with each part between '&', until it returns false.
template <class Take>
void for_each_part(std::string_view form, Take&& take) {
  for (;;) {
    const std::size_t end = form.find('&');
    if (!take(form.substr(0, end)) || end == form.npos) return;
    form.remove_prefix(end + 1);
  }
}

/// The values of a form, by name.
class PushFields {
 public:
  /// Returns nullopt if one of them occurs twice.
  static std::optional<PushFields> of(std::string_view form) noexcept {
    PushFields fields;
    bool are_single = true;
    for_each_part(form, [&](std::string_view part) {
      const std::size_t equals = part.find('=');
      const auto* const name = std::ranges::find(kPushNames, part.substr(0, equals));
      if (equals == part.npos || name == kPushNames.end()) return true;
      auto& value = fields.values_.at(static_cast<std::size_t>(name - kPushNames.begin()));
      are_single = !value;
      value = part.substr(equals + 1);
      return are_single;
    });
    if (!are_single) return std::nullopt;
    return fields;
  }

  bool has(PushName name) const { return values_[name].has_value(); }
  std::string_view text(PushName name) const { return values_[name].value_or(std::string_view()); }

  /// Empty: missing.
  Result<std::optional<double>, Refusal> checked_number(PushName name) const {
    const auto number = parse_number(text(name));
    if (number && *number == kNoPushValue) return std::optional<double>();
    return number;
  }
  /// Nullopt if it is missing, or not a number.
  std::optional<double> number(PushName name, double unit) const {
    const auto number = checked_number(name);
    return number && *number ? std::optional(**number * unit) : std::nullopt;
  }
  /// Of the first of them that is there.
  std::optional<double> first_number(std::initializer_list<PushName> names, double unit) const {
    for (const PushName name : names) {
      if (const auto found = number(name, unit)) return found;
    }
    return std::nullopt;
  }

 private:
  std::array<std::optional<std::string_view>, kPushNames.size()> values_{};
};

Result<DecodedWind, Refusal> wind_of_push(const PushFields& fields, const PushedWindNames& names) {
  const auto speed = fields.checked_number(names.speed);
  const auto gust = fields.checked_number(names.gust);
  const auto direction_deg = fields.checked_number(names.direction);
  if (!speed || !gust || !direction_deg) return Refusal::kMalformed;
  if (!*speed) return Refusal::kInvalid;

  DecodedWind wind = {.speed_m_s = **speed * names.unit_m_s, .direction_deg = {}, .gust_m_s = {}};
  if (*gust && **gust >= **speed) wind.gust_m_s = **gust * names.unit_m_s;
  if (*direction_deg) {
    wind.direction_deg = wrapped_direction_deg(**direction_deg);
    if (!wind.direction_deg) return Refusal::kImplausible;
  }
  return checked(wind);
}

wind::StationQuantities quantities_of_push(const PushFields& fields) {
  wind::StationQuantities said;
  if (const auto temperature_f = fields.number(kPushTemperature, 1.0))
    said.air_temperature_c = (*temperature_f - 32.0) / 1.8;
  said.relative_humidity_percent = fields.number(kPushHumidity, 1.0);
  said.pressure_hpa = fields.first_number(
      {kPushPressure, kPushWuPressure, kPushWuSeaLevelPressure, kPushSeaLevelPressure}, kHectopascalsPerInchOfMercury);
  said.rain_rate_mm_h = fields.first_number({kPushRainRate, kPushPiezoRainRate}, kMillimetresPerInch);
  said.rain_total_mm =
      fields.first_number({kPushRainTotal, kPushRainOfYear, kPushPiezoRainOfYear, kPushRainOfDay, kPushPiezoRainOfDay},
                          kMillimetresPerInch);
  return said;
}

wind::StationQuantities quantities_of_link(const PushFields& fields) {
  wind::StationQuantities said;
  said.pressure_hpa = fields.first_number({kLinkPressure, kLinkSeaLevelPressure}, 1.0);
  if (fields.text(kLinkIsReceived) == "0") return said;
  said.air_temperature_c = fields.number(kLinkTemperature, 1.0);
  said.relative_humidity_percent = fields.number(kLinkHumidity, 1.0);
  said.rain_rate_mm_h = fields.number(kLinkRainRate, 1.0);
  said.rain_total_mm = fields.number(kLinkRainOfYear, 1.0);
  return said;
}

/// A form of WSLink with at least a station or a wind.
StationPush push_of_link(const PushFields& fields) {
  StationPush push;
  push.identity = fields.text(kLinkId);
  push.kind = "WSLink";
  push.quantities = quantities_of_link(fields);
  if (fields.text(kLinkIsReceived) != "0") push.wind = wind_of_push(fields, kLinkWind);
  return push;
}

std::optional<char> byte_of_hex(std::string_view digits) {
  std::uint8_t byte = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), byte, 16);
  if (digits.size() != 2 || error != std::errc{} || end != digits.data() + digits.size()) return std::nullopt;
  return static_cast<char>(byte);
}

bool names_a_secret(std::string_view part) {
  std::string words = percent_decoded(part);
  std::ranges::transform(words, words.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  constexpr std::array<std::string_view, 6> kSecretWords = {"key", "pass", "pwd", "wspw", "token", "secret"};
  return std::ranges::any_of(kSecretWords,
                             [&](std::string_view word) { return words.find(word) != std::string::npos; });
}

}  // namespace

std::string percent_decoded(std::string_view text) {
  std::string decoded;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const auto byte = text[at] == '%' ? byte_of_hex(text.substr(at + 1, 2)) : std::nullopt;
    decoded += byte ? *byte : text[at] == '+' ? ' ' : text[at];
    if (byte) at += 2;
  }
  return decoded;
}

PushTarget split_push_target(std::string_view target) noexcept {
  std::size_t path_size = target.find('?');
  std::size_t form_begin = target.size();
  if (path_size != target.npos) {
    form_begin = path_size + 1;
  } else if (const std::size_t equals = target.find('='); equals != target.npos) {
    const std::size_t slash = target.substr(0, equals).rfind('/');
    path_size = form_begin = slash == target.npos ? 0 : slash + 1;
  } else {
    path_size = target.size();
  }
  std::string_view path = target.substr(0, path_size);
  while (!path.empty() && path.back() == '/') path.remove_suffix(1);
  return {.path = path, .form = target.substr(form_begin)};
}

Result<StationPush, Refusal> decode_station_push(std::string_view form) noexcept {
  if (form.size() > kMaxStationPush) return Refusal::kMalformed;
  form = trimmed(form);
  if (form.empty()) return Refusal::kTooShort;
  if (!std::ranges::all_of(form, [](char c) { return c > ' ' && c <= '~'; })) return Refusal::kMalformed;
  const auto fields = PushFields::of(form);
  if (!fields) return Refusal::kMalformed;

  StationPush push;
  push.identity = fields->text(fields->has(kPushPasskey) ? kPushPasskey : kPushId);
  push.kind = fields->text(fields->has(kPushStationType) ? kPushStationType : kPushSoftwareType);
  if (push.identity.empty() && !fields->has(kPushSpeed)) {
    if (fields->has(kLinkSpeed) || !fields->text(kLinkId).empty()) return push_of_link(*fields);
    return Refusal::kNotMine;
  }
  push.quantities = quantities_of_push(*fields);
  push.wind = wind_of_push(*fields, kPushedWind);
  return push;
}

std::string without_push_secrets(std::string_view form) {
  std::string shown;
  bool is_first = true;
  for_each_part(form, [&](std::string_view part) {
    if (!is_first) shown += '&';
    is_first = false;
    if (!names_a_secret(part)) {
      shown += part;
      return true;
    }
    for (const std::string_view name : {"PASSKEY=", "PASSWORD=", "wspw="}) {
      if (part.starts_with(name)) shown += name;
    }
    shown += Secret::kWithheld;
    return true;
  });
  return shown;
}

std::string push_text(std::string_view value) {
  std::string text = percent_decoded(value.substr(0, 3 * kMaxPushText)).substr(0, kMaxPushText);
  std::ranges::replace_if(
      text, [](char c) { return c < ' ' || c > '~'; }, '?');
  return text;
}

}  // namespace yuragi::drivers::decode::network
