#include "drivers/decode/marine/signalk.hpp"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "engine/base/units.hpp"
#include "engine/wind/wind_reading.hpp"

namespace yuragi::drivers::decode::marine {
namespace {

using SignalKJson = nlohmann::json;

constexpr std::size_t kMaxText = 64;
constexpr std::string_view kWindPath = "environment.wind.";
constexpr std::array<std::string_view, kSignalKQuantities> kQuantityNames = {
    "speedApparent",  "speedTrue",       "speedOverGround", "angleApparent",
    "angleTrueWater", "angleTrueGround", "directionTrue",   "directionMagnetic"};

bool is_speed(std::size_t quantity) {
  return quantity <= static_cast<std::size_t>(SignalKQuantity::kSpeedOverGround);
}

/// The text of that name in an object, cut and printable; empty if there is none.
std::string shown_text(const SignalKJson& object, const char* name) {
  const auto found = object.find(name);
  if (found == object.end() || !found->is_string()) return {};
  std::string text = found->get_ref<const std::string&>().substr(0, kMaxText);
  std::ranges::replace_if(
      text, [](char c) { return c < ' ' || c > '~'; }, '.');
  return text;
}

std::string full_text(const SignalKJson& object, const char* name) {
  const auto found = object.find(name);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

/// Returns "$source", or the same made from "source": "n2k.105".
std::string source_of(const SignalKJson& update) {
  std::string named = shown_text(update, "$source");
  const auto source = update.find("source");
  if (!named.empty() || source == update.end() || !source->is_object()) return named;
  named = shown_text(*source, "label");
  for (const char* part : {"src", "talker"}) {
    const std::string text = shown_text(*source, part);
    if (text.empty()) continue;
    named.append(".").append(text);
    return named.substr(0, kMaxText);
  }
  return named;
}

/// In [0, 360); nullopt if it is not an angle.
std::optional<double> turned_deg(double angle_rad) {
  const double angle_deg = angle_rad / kRadPerDeg;
  return wrapped_direction_deg(angle_deg < 0.0 ? angle_deg + 360.0 : angle_deg);
}

/// The values found so far.
struct WindFinds {
  bool has_path = false;
  bool has_value = false;
  bool is_impossible = false;
};

/// Returns false if it is not this format.
bool take_value(const SignalKJson& entry, SignalKValues& values, WindFinds& finds) {
  if (!entry.is_object()) return false;
  const auto path = entry.find("path");
  const auto value = entry.find("value");
  if (path == entry.end() || !path->is_string()) return false;
  const std::string_view name = path->get_ref<const std::string&>();
  if (!name.starts_with(kWindPath)) return true;
  const auto* const known = std::ranges::find(kQuantityNames, name.substr(kWindPath.size()));
  if (known == kQuantityNames.end()) return true;
  finds.has_path = true;
  if (value == entry.end() || value->is_null()) return true;
  if (!value->is_number()) return false;

  const auto quantity = static_cast<std::size_t>(known - kQuantityNames.begin());
  const double number = value->get<double>();
  if (!is_speed(quantity)) {
    values[quantity] = turned_deg(number);
  } else if (number >= 0.0 && number <= wind::kMaxPlausibleSpeed_m_s) {
    values[quantity] = number;
  } else {
    finds.is_impossible = true;
  }
  finds.has_value = finds.has_value || values[quantity].has_value();
  return true;
}

}  // namespace

std::optional<SignalKHello> signalk_hello(std::string_view line) {
  if (line.find("\"version\"") == std::string_view::npos || line.find("\"updates\"") != std::string_view::npos)
    return {};
  const SignalKJson json = SignalKJson::parse(line, nullptr, false);
  if (!json.is_object() || !json.contains("version") || (!json.contains("roles") && !json.contains("self"))) return {};
  return SignalKHello{.timestamp = shown_text(json, "timestamp"), .self = full_text(json, "self")};
}

Result<SignalKDelta, Refusal> decode_signalk(std::string_view line) {
  const SignalKJson json = SignalKJson::parse(line, nullptr, false);
  if (!json.is_object()) return Refusal::kMalformed;
  const auto updates = json.find("updates");
  if (updates == json.end()) return Refusal::kNotMine;
  if (!updates->is_array()) return Refusal::kMalformed;

  SignalKDelta delta;
  delta.context = full_text(json, "context");
  WindFinds finds;
  for (const SignalKJson& update : *updates) {
    if (!update.is_object()) return Refusal::kMalformed;
    const auto values = update.find("values");
    if (values == update.end()) continue;  // descriptions of the values ("meta")
    if (!values->is_array()) return Refusal::kMalformed;
    SignalKUpdate said = {.source = source_of(update), .timestamp = shown_text(update, "timestamp"), .values = {}};
    for (const SignalKJson& entry : *values) {
      if (!take_value(entry, said.values, finds)) return Refusal::kMalformed;
    }
    const bool has_any = std::ranges::any_of(said.values, [](const auto& value) { return value.has_value(); });
    if (has_any) delta.updates.push_back(std::move(said));
  }
  if (!finds.has_path) return Refusal::kNotMine;
  if (finds.is_impossible) return Refusal::kImplausible;
  if (!finds.has_value) return Refusal::kInvalid;
  return delta;
}

std::array<std::optional<SignalKWind>, kSignalKFrames> signalk_winds(const SignalKValues& values) noexcept {
  const auto value_of = [&](SignalKQuantity quantity) { return values[static_cast<std::size_t>(quantity)]; };
  const auto wind_of = [&](std::string_view frame, std::optional<double> speed_m_s, SignalKQuantity direction,
                           WindReference reference) -> std::optional<SignalKWind> {
    if (!speed_m_s) return {};
    SignalKWind made = {.frame = frame, .wind = {}};
    made.wind.speed_m_s = speed_m_s;
    made.wind.direction_deg = value_of(direction);
    made.wind.reference = reference;
    return made;
  };
  const auto over_ground_m_s = value_of(SignalKQuantity::kSpeedOverGround);
  const auto true_m_s = value_of(SignalKQuantity::kSpeedTrue);
  const auto from_north_m_s = over_ground_m_s ? over_ground_m_s : true_m_s;
  auto north = wind_of("north", from_north_m_s, SignalKQuantity::kDirectionTrue, WindReference::kNorth);
  auto magnetic = wind_of("magnetic", from_north_m_s, SignalKQuantity::kDirectionMagnetic, WindReference::kMagnetic);
  // A true speed without a direction from north belongs to an angle from the bow.
  if (north && !north->wind.direction_deg) north.reset();
  if (magnetic && !magnetic->wind.direction_deg) magnetic.reset();
  return {north, magnetic,
          wind_of("apparent", value_of(SignalKQuantity::kSpeedApparent), SignalKQuantity::kAngleApparent,
                  WindReference::kRelative),
          wind_of("ground", over_ground_m_s, SignalKQuantity::kAngleTrueGround, WindReference::kTrue),
          wind_of("water", true_m_s, SignalKQuantity::kAngleTrueWater, WindReference::kTrue)};
}

}  // namespace yuragi::drivers::decode::marine
