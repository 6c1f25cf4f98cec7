#include "drivers/decode/network/json_wind.hpp"

#include <nlohmann/json.hpp>

#include "drivers/decode/json_value.hpp"
#include "engine/base/json_text.hpp"
#include "engine/wind/wind_reading.hpp"

namespace yuragi::drivers::decode::network {
namespace {

using Json = nlohmann::json;

const Json* value_of(const Json& answer, const std::string& pointer) {
  return pointer.empty() ? nullptr : json_at(answer, pointer);
}

void add_direction(const Json* value, DecodedWind& wind) {
  const auto direction_deg = json_direction(value);
  if (direction_deg && *direction_deg) wind.direction_deg = wrapped_direction_deg(**direction_deg);
  const bool is_missing = direction_deg ? !*direction_deg : direction_deg.error() == Refusal::kInvalid;
  if (!is_missing && !wind.direction_deg) wind.status = DecodedStatus::kUncertain;
}

void add_gust(const Json* value, double metres_per_second, DecodedWind& wind) {
  const auto number = json_number(value);
  if (number && *number) {
    const double gust_m_s = **number * metres_per_second;
    if (gust_m_s >= 0.0 && gust_m_s <= wind::kMaxPlausibleSpeed_m_s) wind.gust_m_s = gust_m_s;
  }
  const bool is_missing = number ? !*number : number.error() == Refusal::kInvalid;
  if (!is_missing && !wind.gust_m_s) wind.status = DecodedStatus::kUncertain;
}

std::string time_text(const Json* value) {
  if (value == nullptr || (!value->is_string() && !value->is_number())) return {};
  std::string text = value->is_string() ? value->get<std::string>() : json_text(*value);
  return text.size() <= kMaxJsonTime ? text : std::string();
}

}  // namespace

Result<JsonWind, Refusal> decode_json_wind(std::string_view answer, const JsonPlaces& places) {
  if (answer.size() > kMaxJsonAnswer) return Refusal::kMalformed;
  const Json json = parse_json(answer);
  if (json.is_discarded()) return Refusal::kMalformed;
  const auto speed = json_number(value_of(json, places.speed));
  if (!speed) return speed.error();
  if (!*speed) return Refusal::kInvalid;

  DecodedWind wind;
  wind.speed_m_s = **speed * places.metres_per_second;
  add_direction(value_of(json, places.direction), wind);
  add_gust(value_of(json, places.gust), places.metres_per_second, wind);
  const auto sound = checked(wind);
  if (!sound) return sound.error();
  return JsonWind{.wind = *sound, .time = time_text(value_of(json, places.time))};
}

}  // namespace yuragi::drivers::decode::network
