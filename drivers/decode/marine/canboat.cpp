#include "drivers/decode/marine/canboat.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <nlohmann/json.hpp>

#include "drivers/decode/text_fields.hpp"
#include "engine/base/units.hpp"

namespace yuragi::drivers::decode::marine {
namespace {

using CanboatJson = nlohmann::json;

constexpr double kMaxAngle_rad = 6.5535;  // 0xFFFF in the frame
constexpr std::array<std::string_view, 5> kReferenceTexts = {
    "True (ground referenced to North)", "Magnetic (ground referenced to Magnetic North)", "Apparent",
    "True (boat referenced)", "True (water referenced)"};

/// The names of a field: as it is, in camel case, in upper camel case.
using FieldNames = std::array<const char*, 3>;
constexpr FieldNames kWindSpeedNames = {"Wind Speed", "windSpeed", "WindSpeed"};
constexpr FieldNames kWindAngleNames = {"Wind Angle", "windAngle", "WindAngle"};
constexpr FieldNames kReferenceNames = {"Reference", "reference", "Reference"};

/// Returns nullptr if it is missing or null.
const CanboatJson* field_of(const CanboatJson& fields, const FieldNames& names) {
  for (const char* name : names) {
    const auto found = fields.find(name);
    if (found != fields.end() && !found->is_null()) return &*found;
  }
  return nullptr;
}

/// A number, also as a text.
std::optional<double> number_of(const CanboatJson& value) {
  if (value.is_number()) return value.get<double>();
  if (!value.is_string()) return {};
  const auto number = parse_number(value.get_ref<const std::string&>());
  return number ? *number : std::nullopt;
}

/// Returns nullopt if there is none, kMalformed if it is not a number.
Result<std::optional<double>, Refusal> number_field(const CanboatJson& fields, const FieldNames& names) {
  const CanboatJson* const value = field_of(fields, names);
  if (value == nullptr) return std::optional<double>();
  const auto number = number_of(*value);
  if (!number || !std::isfinite(*number)) return Refusal::kMalformed;
  return number;
}

Result<WindDataReference, Refusal> reference_field(const CanboatJson& fields) {
  const CanboatJson* value = field_of(fields, kReferenceNames);
  if (value == nullptr) return WindDataReference::kUnknown;
  if (value->is_object()) {
    const auto number = value->find("value");
    if (number == value->end()) return Refusal::kMalformed;
    value = &*number;
  }
  std::size_t code = kReferenceTexts.size();
  if (value->is_number_unsigned()) {
    code = value->get<std::size_t>();
  } else if (value->is_string()) {
    const auto* const found = std::ranges::find(kReferenceTexts, value->get_ref<const std::string&>());
    code = static_cast<std::size_t>(found - kReferenceTexts.begin());
  }
  if (code >= kReferenceTexts.size()) return Refusal::kMalformed;
  return static_cast<WindDataReference>(code);
}

/// The record of wind data in a line, or why there is none.
Result<const CanboatJson*, Refusal> wind_record_in(const CanboatJson& line) {
  if (!line.is_object()) return Refusal::kMalformed;
  const CanboatJson* record = &line;
  for (const char* name : {"windData", "WindData"}) {
    const auto wrapped = line.find(name);
    if (wrapped != line.end() && wrapped->is_object()) record = &*wrapped;
  }
  const auto pgn = record->find("pgn");
  if (pgn == record->end() || number_of(*pgn) != static_cast<double>(kWindDataPgn)) return Refusal::kNotMine;
  const auto fields = record->find("fields");
  if (fields == record->end() || !fields->is_object()) return Refusal::kMalformed;
  return record;
}

}  // namespace

std::optional<AngleUnit> canboat_angle_unit(std::string_view line) {
  if (line.find("\"units\"") == std::string_view::npos) return {};
  const CanboatJson header = CanboatJson::parse(line, nullptr, false);
  if (!header.is_object() || !header.contains("version")) return {};
  const auto units = header.find("units");
  if (units == header.end()) return {};
  if (*units == "std") return AngleUnit::kDegrees;
  if (*units == "si") return AngleUnit::kRadians;
  return {};
}

Result<BusWind, Refusal> decode_canboat(const CanboatOptions& options, std::string_view line) {
  const CanboatJson json = CanboatJson::parse(line, nullptr, false);
  const auto found = wind_record_in(json);
  if (!found) return found.error();
  const CanboatJson& record = **found;
  const CanboatJson& fields = record.at("fields");
  const auto speed_m_s = number_field(fields, kWindSpeedNames);
  const auto angle = number_field(fields, kWindAngleNames);
  const auto reference = reference_field(fields);
  const auto src = record.find("src");
  const double address = src == record.end() ? -1.0 : number_of(*src).value_or(-1.0);
  if (!speed_m_s || !angle || !reference || !(address >= 0.0 && address <= 255.0)) return Refusal::kMalformed;
  if (!*speed_m_s) return Refusal::kInvalid;

  BusWind said;
  said.address = static_cast<std::uint8_t>(address);
  said.reference = *reference;
  said.wind.reference = wind_reference_of(*reference);
  said.wind.speed_m_s = *speed_m_s;
  if (*angle) {
    const bool is_beyond_radians = **angle > kMaxAngle_rad;
    const bool is_known = options.angle_unit || is_beyond_radians;
    const AngleUnit unit = options.angle_unit.value_or(AngleUnit::kDegrees);
    if (is_known) {
      said.wind.direction_deg =
          unit == AngleUnit::kDegrees ? wrapped_direction_deg(**angle) : direction_of_angle_deg(**angle);
      if (!said.wind.direction_deg) said.wind.status = DecodedStatus::kUncertain;
    }
  }
  const auto wind = checked(said.wind);
  if (!wind) return wind.error();
  return said;
}

}  // namespace yuragi::drivers::decode::marine
