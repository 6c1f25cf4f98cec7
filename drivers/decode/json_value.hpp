#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "drivers/decode/refusal.hpp"
#include "engine/base/result.hpp"

namespace yuragi::drivers::decode {

// Values in JSON that a stranger has sent. Nothing here throws anything but std::bad_alloc, whatever the bytes are.
// Thread-safe: yes.

/// Parses the text; discarded (is_discarded()) if it is not JSON. Values that stand deeper than 64 levels are left out,
/// so that a text of brackets alone takes no more memory than others.
nlohmann::json parse_json(std::string_view text);

/// Returns the value at a JSON pointer (is_json_pointer()); nullptr if there is no such place.
const nlohmann::json* json_at(const nlohmann::json& json, const std::string& pointer);

/// The number that a text stands for, with exponents. kInvalid: a word for no value, as Home Assistant sends it
/// (unavailable, unknown, none, an empty text). kMalformed: anything else.
Result<double, Refusal> number_of_text(std::string_view text);

/// The direction in degrees that a text stands for: a compass point ("NW", in capitals or not), or as number_of_text().
/// kInvalid: also "VRB", by which weather services mean a direction that varies.
Result<double, Refusal> direction_of_text(std::string_view text);

/// The number that stands there; nullopt for null and for no place (nullptr). A text is read as number_of_text() does.
/// kMalformed: something else.
Result<std::optional<double>, Refusal> json_number(const nlohmann::json* value);

/// The same for a direction in degrees; a text is read as direction_of_text() does.
Result<std::optional<double>, Refusal> json_direction(const nlohmann::json* value);

}  // namespace yuragi::drivers::decode
