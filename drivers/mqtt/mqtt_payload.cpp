#include "drivers/mqtt/mqtt_payload.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include <nlohmann/json.hpp>

#include "drivers/decode/text_fields.hpp"

namespace yuragi::drivers::mqtt {
namespace {

using Json = nlohmann::json;

Result<std::optional<double>, decode::Refusal> number_of_text(std::string_view text) {
  constexpr std::array<std::string_view, 7> kNoValue = {"", "unavailable", "unknown", "none", "None", "null", "nan"};
  text = decode::trimmed(text);
  if (std::ranges::find(kNoValue, text) != kNoValue.end()) return decode::Refusal::kInvalid;
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(number))
    return decode::Refusal::kMalformed;
  return std::optional(number);
}

}  // namespace

bool is_json_pointer(const std::string& text) {
  try {
    static_cast<void>(Json::json_pointer(text));
    return true;
  } catch (const Json::exception&) {
    return false;
  }
}

Result<std::optional<double>, decode::Refusal> number_in(std::string_view payload, const PayloadPlace& place) {
  if (!place.is_json()) return number_of_text(payload);
  try {
    const Json json = Json::parse(payload, nullptr, false);
    if (json.is_discarded()) return decode::Refusal::kMalformed;
    const Json::json_pointer pointer(place.pointer);
    if (!json.contains(pointer)) return std::optional<double>();
    const Json& value = json.at(pointer);
    if (value.is_null()) return std::optional<double>();
    if (value.is_string()) return number_of_text(value.get_ref<const std::string&>());
    if (!value.is_number()) return decode::Refusal::kMalformed;
    return std::optional(value.get<double>());
  } catch (const Json::exception&) {
    return decode::Refusal::kMalformed;  // an index that no array can have
  }
}

}  // namespace yuragi::drivers::mqtt
