#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace yuragi {

/// Returns `json` as text. `indent`: spaces for each level; negative: one line. Bytes that are not UTF-8 become U+FFFD:
/// a text from outside may hold any, and nlohmann's `dump()` throws for them, so no other function writes JSON.
template <class Json>
std::string json_text(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

/// The same in one line, with characters beyond ASCII as \uXXXX: safe in any terminal.
template <class Json>
std::string ascii_json_text(const Json& json) {
  return json.dump(-1, ' ', true, Json::error_handler_t::replace);
}

}  // namespace yuragi
