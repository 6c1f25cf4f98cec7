#include "drivers/mqtt/mqtt_quantities.hpp"

#include <algorithm>
#include <string_view>

namespace yuragi::drivers::mqtt {
namespace {

constexpr double kMillimetresPerInch = 25.4;
/// BIPM, "The International System of Units", 2006, table 8: the millimetre of mercury; the inch is 25.4 of them.
constexpr double kHectopascalPerMillimetreOfMercury = 1.33322;

double celsius_of_fahrenheit(double temperature_f) {
  return (temperature_f - 32.0) / 1.8;
}

std::optional<double> number_in_message(const Payload& payload, const std::string& pointer) {
  const auto number = payload.number_at(pointer);
  return number ? *number : std::nullopt;
}

/// The same, in another unit.
std::optional<double> scaled(std::optional<double> number, double factor) {
  if (number) *number *= factor;
  return number;
}

std::optional<wind::StationQuantities> unless_empty(const wind::StationQuantities& quantities) {
  const bool has_any = std::ranges::any_of(wind::kStationQuantities,
                                           [&](const auto& each) { return (quantities.*each.value).has_value(); });
  return has_any ? std::optional(quantities) : std::nullopt;
}

/// Returns the number under that key in the one sensor of a Tasmota that has it; nullopt if two have it.
std::optional<double> of_the_only_sensor(const nlohmann::json& message, const char* key) {
  constexpr std::string_view kChip = "ESP32";
  std::optional<double> found;
  for (const auto& [sensor, values] : message.items()) {
    if (sensor == kChip || !values.is_object()) continue;
    const auto value = values.find(key);
    if (value == values.end() || !value->is_number()) continue;
    if (found) return std::nullopt;
    found = value->get<double>();
  }
  return found;
}

}  // namespace

std::optional<wind::StationQuantities> quantities_of_rtl_433(const Payload& payload) {
  const auto first_of = [](std::optional<double> one, std::optional<double> other) { return one ? one : other; };
  wind::StationQuantities said;
  said.air_temperature_c = number_in_message(payload, "/temperature_C");
  if (const auto temperature_f = number_in_message(payload, "/temperature_F"); temperature_f && !said.air_temperature_c)
    said.air_temperature_c = celsius_of_fahrenheit(*temperature_f);
  said.relative_humidity_percent = number_in_message(payload, "/humidity");
  said.pressure_hpa = number_in_message(payload, "/pressure_hPa");
  said.rain_total_mm = first_of(number_in_message(payload, "/rain_mm"),
                                scaled(number_in_message(payload, "/rain_in"), kMillimetresPerInch));
  said.rain_rate_mm_h = first_of(number_in_message(payload, "/rain_rate_mm_h"),
                                 scaled(number_in_message(payload, "/rain_rate_in_h"), kMillimetresPerInch));
  return unless_empty(said);
}

std::optional<wind::StationQuantities> quantities_of_tasmota(const Payload& payload) {
  if (!payload.json().is_object()) return std::nullopt;
  wind::StationQuantities said;
  said.air_temperature_c = of_the_only_sensor(payload.json(), "Temperature");
  if (said.air_temperature_c && payload.text_at("/TempUnit") == "F")
    said.air_temperature_c = celsius_of_fahrenheit(*said.air_temperature_c);
  said.relative_humidity_percent = of_the_only_sensor(payload.json(), "Humidity");
  said.pressure_hpa = of_the_only_sensor(payload.json(), "Pressure");
  const auto pressure_unit = payload.text_at("/PressureUnit");
  if (pressure_unit == "mmHg") said.pressure_hpa = scaled(said.pressure_hpa, kHectopascalPerMillimetreOfMercury);
  if (pressure_unit == "inHg")
    said.pressure_hpa = scaled(said.pressure_hpa, kHectopascalPerMillimetreOfMercury * kMillimetresPerInch);
  return unless_empty(said);
}

}  // namespace yuragi::drivers::mqtt
