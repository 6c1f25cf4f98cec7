#include "drivers/decode/json_value.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <system_error>

#include "drivers/decode/text_fields.hpp"
#include "engine/base/compass.hpp"

namespace yuragi::drivers::decode {
namespace {

using Json = nlohmann::json;

constexpr int kMaxDepth = 64;

}  // namespace

Json parse_json(std::string_view text) {
  const auto is_kept = [](int depth, Json::parse_event_t /*event*/, Json& /*value*/) { return depth <= kMaxDepth; };
  return Json::parse(text, is_kept, false);
}

const Json* json_at(const Json& json, const std::string& pointer) {
  if (json.is_discarded()) return nullptr;
  try {
    const Json::json_pointer place(pointer);
    return json.contains(place) ? &json.at(place) : nullptr;
  } catch (const Json::exception&) {
    return nullptr;  // an index that no array can have
  }
}

Result<double, Refusal> number_of_text(std::string_view text) {
  constexpr std::array<std::string_view, 7> kNoValue = {"", "unavailable", "unknown", "none", "None", "null", "nan"};
  text = trimmed(text);
  if (std::ranges::find(kNoValue, text) != kNoValue.end()) return Refusal::kInvalid;
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(number)) return Refusal::kMalformed;
  return number;
}

Result<double, Refusal> direction_of_text(std::string_view text) {
  text = trimmed(text);
  if (const auto point_deg = compass_point_deg(text)) return *point_deg;
  if (text == "VRB") return Refusal::kInvalid;
  return number_of_text(text);
}

Result<std::optional<double>, Refusal> json_number(const Json* value) {
  if (value == nullptr || value->is_null()) return std::optional<double>();
  if (value->is_string()) {
    const auto number = number_of_text(value->get_ref<const std::string&>());
    if (!number) return number.error();
    return std::optional(*number);
  }
  if (!value->is_number()) return Refusal::kMalformed;
  return std::optional(value->get<double>());
}

Result<std::optional<double>, Refusal> json_direction(const Json* value) {
  if (value == nullptr || !value->is_string()) return json_number(value);
  const auto direction_deg = direction_of_text(value->get_ref<const std::string&>());
  if (!direction_deg) return direction_deg.error();
  return std::optional(*direction_deg);
}

}  // namespace yuragi::drivers::decode
