#include "drivers/mqtt/mqtt_payload.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "drivers/decode/text_fields.hpp"
#include "engine/base/json_text.hpp"

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

Payload::Payload(std::string_view bytes, PayloadForm form)
    : bytes_(bytes),
      json_(form == PayloadForm::kJson ? Json::parse(bytes, nullptr, false) : Json(Json::value_t::discarded)) {}

/// Throws Json::exception for an index that no array can have.
const Json* Payload::find(const std::string& pointer) const {
  const Json::json_pointer place(pointer);
  return json_.contains(place) ? &json_.at(place) : nullptr;
}

bool Payload::lacks(const std::string& pointer) const {
  if (pointer.empty() || json_.is_discarded()) return false;
  try {
    return find(pointer) == nullptr;
  } catch (const Json::exception&) {
    return false;
  }
}

Result<std::optional<double>, decode::Refusal> Payload::number_at(const std::string& pointer) const {
  if (pointer.empty()) return number_of_text(bytes_);
  if (json_.is_discarded()) return decode::Refusal::kMalformed;
  try {
    const Json* const value = find(pointer);
    if (value == nullptr || value->is_null()) return std::optional<double>();
    if (value->is_string()) return number_of_text(value->get_ref<const std::string&>());
    if (!value->is_number()) return decode::Refusal::kMalformed;
    return std::optional(value->get<double>());
  } catch (const Json::exception&) {
    return decode::Refusal::kMalformed;
  }
}

std::optional<std::string> Payload::text_at(const std::string& pointer) const {
  if (json_.is_discarded()) return std::nullopt;
  try {
    const Json* const value = find(pointer);
    if (value == nullptr) return std::nullopt;
    if (value->is_string()) return value->get<std::string>();
    if (value->is_number_integer()) return json_text(*value);
  } catch (const Json::exception&) {
    return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace yuragi::drivers::mqtt
