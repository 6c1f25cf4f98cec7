#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "drivers/decode/refusal.hpp"
#include "engine/base/result.hpp"

namespace yuragi::drivers::mqtt {

/// Where in a message's payload a number stands.
struct PayloadPlace {
  std::string pointer;  ///< a JSON pointer (RFC 6901), such as /TX23/Speed/Act; empty: the payload is the number

  bool is_json() const noexcept { return !pointer.empty(); }
};

/// Is it a JSON pointer, or empty?
bool is_json_pointer(const std::string& text);

/// The number at that place; nothing where a JSON payload does not have the place, or has null there. Text that reads
/// as a number counts as one, in JSON too. kInvalid: a text that stands for no value, as Home Assistant sends it
/// (unavailable, unknown, none, an empty payload). kMalformed: not JSON, or something else there. Never throws for any
/// payload. Thread-safe: yes.
Result<std::optional<double>, decode::Refusal> number_in(std::string_view payload, const PayloadPlace& place);

}  // namespace yuragi::drivers::mqtt
