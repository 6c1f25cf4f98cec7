#include "drivers/mqtt/mqtt_payload.hpp"

#include "drivers/decode/json_value.hpp"
#include "engine/base/json_text.hpp"

namespace yuragi::drivers::mqtt {

using Json = nlohmann::json;

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
  if (pointer.empty()) {
    const auto number = decode::number_of_text(bytes_);
    if (!number) return number.error();
    return std::optional(*number);
  }
  if (json_.is_discarded()) return decode::Refusal::kMalformed;
  try {
    return decode::json_number(find(pointer));
  } catch (const Json::exception&) {
    return decode::Refusal::kMalformed;
  }
}

Result<std::optional<double>, decode::Refusal> Payload::direction_at(const std::string& pointer) const {
  if (pointer.empty()) {
    const auto direction_deg = decode::direction_of_text(bytes_);
    if (!direction_deg) return direction_deg.error();
    return std::optional(*direction_deg);
  }
  if (json_.is_discarded()) return decode::Refusal::kMalformed;
  try {
    return decode::json_direction(find(pointer));
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
