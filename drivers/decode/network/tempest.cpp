#include "drivers/decode/network/tempest.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>

namespace yuragi::drivers::decode::network {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMaxSerialNumber = 32;
constexpr double kLatestTime_s = 1e12;
constexpr double kMinutesInHour = 60.0;
/// No value stands there.
constexpr std::size_t kNowhere = static_cast<std::size_t>(-1);

/// The positions of the values in an observation of one kind of station.
struct ObservationLayout {
  std::string_view type;
  std::size_t size;
  std::size_t average;
  std::size_t gust;
  std::size_t direction;
  std::size_t pressure;
  std::size_t temperature;
  std::size_t humidity;
  std::size_t rain_of_minute;
  std::size_t rain_of_day;
  std::size_t report_interval;
};
constexpr ObservationLayout kTempestLayout = {"obs_st", 18, 2, 3, 4, 6, 7, 8, 12, kNowhere, 17};
constexpr ObservationLayout kSkyLayout = {"obs_sky", 14, 5, 6, 7, kNowhere, kNowhere, kNowhere, 3, 11, 9};

bool is_serial_number(const std::string& text) {
  const bool is_printable = std::ranges::all_of(text, [](char c) { return c > ' ' && c <= '~'; });
  return !text.empty() && text.size() <= kMaxSerialNumber && is_printable;
}

/// The text of that name in an object; empty if there is none.
std::string text_of(const Json& message, const char* name) {
  const auto found = message.find(name);
  return found != message.end() && found->is_string() ? found->get_ref<const std::string&>() : std::string();
}

/// Empty for null, and beyond the end.
std::optional<double> value_at(const Json& values, std::size_t at) {
  if (at >= values.size() || values[at].is_null()) return std::nullopt;
  return values[at].get<double>();
}

/// Why these are no values of a message that has `size` of them.
std::optional<Refusal> values_refusal(const Json& values, std::size_t size) {
  if (!values.is_array()) return Refusal::kMalformed;
  const bool are_numbers =
      std::ranges::all_of(values, [](const Json& value) { return value.is_number() || value.is_null(); });
  if (!are_numbers) return Refusal::kMalformed;
  if (values.size() < size) return Refusal::kTooShort;
  const auto time_s = value_at(values, 0);
  if (!time_s || !(*time_s > 0.0 && *time_s < kLatestTime_s)) return Refusal::kMalformed;
  return std::nullopt;
}

Result<DecodedWind, Refusal> wind_of(std::optional<double> speed_m_s, std::optional<double> direction_deg,
                                     std::optional<double> gust_m_s) {
  if (!speed_m_s) return Refusal::kInvalid;
  if (gust_m_s && *gust_m_s < *speed_m_s) return Refusal::kImplausible;
  DecodedWind wind = {.speed_m_s = speed_m_s, .direction_deg = {}, .gust_m_s = gust_m_s};
  if (direction_deg) {
    wind.direction_deg = wrapped_direction_deg(*direction_deg);
    if (!wind.direction_deg) wind.status = DecodedStatus::kUncertain;  // the speed is still one
  }
  if (*speed_m_s == 0.0) wind.direction_deg.reset();
  return checked(wind);
}

wind::StationQuantities quantities_of(const Json& values, const ObservationLayout& layout) {
  wind::StationQuantities said;
  said.air_temperature_c = value_at(values, layout.temperature);
  said.pressure_hpa = value_at(values, layout.pressure);
  said.relative_humidity_percent = value_at(values, layout.humidity);
  said.rain_total_mm = value_at(values, layout.rain_of_day);
  // A station that saves its battery reports less often than each minute; over which time it then sums the rain is
  // unknown.
  const auto rain_of_minute_mm = value_at(values, layout.rain_of_minute);
  if (rain_of_minute_mm && value_at(values, layout.report_interval) == 1.0)
    said.rain_rate_mm_h = *rain_of_minute_mm * kMinutesInHour;
  return said;
}

/// Adds `values`. Returns why they cannot be used; nullopt if they can.
std::optional<Refusal> take_rapid_wind(const Json& values, TempestMessage& taken) {
  if (const auto refusal = values_refusal(values, 3)) return refusal;
  taken.kind = TempestKind::kRapidWind;
  taken.time_s = static_cast<std::int64_t>(*value_at(values, 0));
  taken.wind = wind_of(value_at(values, 1), value_at(values, 2), {});
  return std::nullopt;
}

/// The same for a list of observations, of which the last is the newest.
std::optional<Refusal> take_observation(const Json& observations, const ObservationLayout& layout,
                                        TempestMessage& taken) {
  if (!observations.is_array() || observations.empty()) return Refusal::kMalformed;
  const Json& values = observations.back();
  if (const auto refusal = values_refusal(values, layout.size)) return refusal;
  taken.kind = TempestKind::kObservation;
  taken.time_s = static_cast<std::int64_t>(*value_at(values, 0));
  taken.wind =
      wind_of(value_at(values, layout.average), value_at(values, layout.direction), value_at(values, layout.gust));
  taken.quantities = quantities_of(values, layout);
  return std::nullopt;
}

}  // namespace

Result<TempestMessage, Refusal> decode_tempest(std::string_view datagram) {
  if (datagram.empty()) return Refusal::kTooShort;
  if (datagram.size() > kMaxTempestMessage) return Refusal::kMalformed;
  const Json message = Json::parse(datagram, nullptr, false);
  if (!message.is_object()) return Refusal::kMalformed;

  TempestMessage taken;
  taken.serial_number = text_of(message, "serial_number");
  taken.hub_serial_number = text_of(message, "hub_sn");
  const std::string type = text_of(message, "type");
  if (!is_serial_number(taken.serial_number) || type.empty()) return Refusal::kMalformed;
  if (type == "hub_status") taken.hub_serial_number = taken.serial_number;
  if (!is_serial_number(taken.hub_serial_number)) return Refusal::kMalformed;

  const auto values = message.find(type == "rapid_wind" ? "ob" : "obs");
  const bool has_wind = type == "rapid_wind" || type == kTempestLayout.type || type == kSkyLayout.type;
  if (!has_wind) return taken;
  if (values == message.end()) return Refusal::kMalformed;
  const auto refusal = type == "rapid_wind"
                           ? take_rapid_wind(*values, taken)
                           : take_observation(*values, type == kSkyLayout.type ? kSkyLayout : kTempestLayout, taken);
  if (refusal) return *refusal;
  return taken;
}

bool TempestWinds::is_new(const TempestMessage& message) noexcept {
  std::int64_t& last_s = message.kind == TempestKind::kRapidWind ? last_rapid_wind_s_ : last_observation_s_;
  return std::exchange(last_s, message.time_s) != message.time_s;
}

bool TempestWinds::is_wind(const TempestMessage& message) noexcept {
  if (message.kind == TempestKind::kRapidWind) {
    rapid_winds_are_missing_ = false;
    return true;
  }
  return std::exchange(rapid_winds_are_missing_, true);
}

}  // namespace yuragi::drivers::decode::network
