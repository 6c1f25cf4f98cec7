#include "drivers/decode/davis/weatherlink_live.hpp"

#include <array>
#include <cmath>

#include <nlohmann/json.hpp>

#include "engine/base/units.hpp"

namespace yuragi::drivers::decode::davis {
namespace {

using Json = nlohmann::json;

constexpr int kStationRecord = 1;
constexpr int kPressureRecord = 3;
constexpr double kSearching = 2.0;
constexpr double kHpaPerInchOfMercury = 33.86389;
/// By rain_size; 0 is reserved.
constexpr std::array<double, 5> kRainOfSizes_mm = {0.0, 0.254, 0.2, 0.1, 0.0254};

/// Returns a finite number; nullopt if it is missing, null or something else.
std::optional<double> number_at(const Json& record, const char* key) {
  const auto found = record.find(key);
  if (found == record.end() || !found->is_number()) return std::nullopt;
  const double number = found->get<double>();
  return std::isfinite(number) ? std::optional(number) : std::nullopt;
}

/// The member, if it is an object or an array; nullptr otherwise.
const Json* part_at(const Json& whole, const char* key) {
  if (!whole.is_object()) return nullptr;
  const auto found = whole.find(key);
  return found != whole.end() && found->is_structured() ? &*found : nullptr;
}

bool is_record(const Json& record, int type) {
  return record.is_object() && number_at(record, "data_structure_type") == type;
}

/// The data of a reply; for a broadcast the whole object.
Result<const Json*, Refusal> data_of(const Json& message) {
  if (!message.is_object()) return Refusal::kMalformed;
  if (part_at(message, "error") != nullptr) return Refusal::kException;
  if (!message.contains("data")) return &message;
  const Json* const data = part_at(message, "data");
  if (data == nullptr || !data->is_object()) return Refusal::kMalformed;
  return data;
}

Result<DecodedWind, Refusal> wind_of(const Json& record) {
  const auto speed_mph = number_at(record, "wind_speed_last");
  const auto direction_deg = number_at(record, "wind_dir_last");
  const auto gust_mph = number_at(record, "wind_speed_hi_last_10_min");
  if (!speed_mph || number_at(record, "rx_state") == kSearching) return Refusal::kInvalid;

  DecodedWind wind;
  wind.speed_m_s = *speed_mph * kMetresPerSecondPerMph;
  wind.reference = WindReference::kNorth;
  const bool is_calm_mark = *speed_mph == 0.0 && direction_deg == 0.0;
  if (direction_deg && !is_calm_mark) {
    if (*direction_deg >= 0.0 && *direction_deg <= 360.0) {
      wind.direction_deg = wrapped_direction_deg(*direction_deg);
    } else {
      wind.status = DecodedStatus::kUncertain;
    }
  }
  if (gust_mph) wind.gust_m_s = *gust_mph * kMetresPerSecondPerMph;
  return checked(wind);
}

void add_station(const Json& record, wind::StationQuantities& said) {
  if (const auto temperature_f = number_at(record, "temp")) said.air_temperature_c = (*temperature_f - 32.0) / 1.8;
  said.relative_humidity_percent = number_at(record, "hum");
  const auto size = number_at(record, "rain_size");
  if (!size || !(*size >= 1.0) || *size >= static_cast<double>(kRainOfSizes_mm.size())) return;
  const double tip_mm = kRainOfSizes_mm[static_cast<std::size_t>(*size)];
  if (const auto rate = number_at(record, "rain_rate_last")) said.rain_rate_mm_h = *rate * tip_mm;
  if (const auto total = number_at(record, "rainfall_daily")) said.rain_total_mm = *total * tip_mm;
}

}  // namespace

Result<LiveConditions, Refusal> decode_live_conditions(std::string_view json, int transmitter) {
  const Json message = Json::parse(json, nullptr, false);
  const auto data = data_of(message);
  if (!data) return data.error();
  const Json* const conditions = part_at(**data, "conditions");
  const auto device = (*data)->find("did");
  if (conditions == nullptr || !conditions->is_array() || device == (*data)->end() || !device->is_string())
    return Refusal::kMalformed;

  LiveConditions decoded;
  decoded.device = device->get<std::string>();
  decoded.time_s = number_at(**data, "ts");
  Refusal refusal = Refusal::kNotMine;
  const Json* station = nullptr;
  for (const Json& record : *conditions) {
    if (is_record(record, kPressureRecord)) {
      if (const auto pressure = number_at(record, "bar_sea_level"))
        decoded.quantities.pressure_hpa = *pressure * kHpaPerInchOfMercury;
    }
    const auto id = number_at(record, "txid");
    if (!is_record(record, kStationRecord) || station != nullptr || !id || *id < 1.0 || *id > 8.0) continue;
    if (transmitter != 0 && *id != transmitter) continue;
    const auto wind = wind_of(record);
    if (wind) {
      station = &record;
      decoded.transmitter = static_cast<int>(*id);
      decoded.wind = *wind;
    } else {
      refusal = wind.error();
    }
  }
  if (station == nullptr) return refusal;
  add_station(*station, decoded.quantities);
  return decoded;
}

Result<std::uint16_t, Refusal> decode_live_broadcast_port(std::string_view json) {
  const Json message = Json::parse(json, nullptr, false);
  const auto data = data_of(message);
  if (!data) return data.error();
  const auto port = number_at(**data, "broadcast_port");
  if (!port || !(*port >= 1.0) || *port > 65535.0) return Refusal::kMalformed;
  return static_cast<std::uint16_t>(*port);
}

}  // namespace yuragi::drivers::decode::davis
