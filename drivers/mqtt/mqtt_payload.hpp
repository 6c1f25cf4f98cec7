#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "drivers/decode/refusal.hpp"
#include "engine/base/result.hpp"

namespace yuragi::drivers::mqtt {

/// How the payload of a message is read.
enum class PayloadForm : std::uint8_t {
  kJson,
  kText,  ///< of one value: JSON in it is not looked for, nor paid for
};

/// The payload of one message, of any bytes: JSON, or the text of one value. It is parsed once. A place in it is a
/// JSON pointer (RFC 6901), such as /TX23/Speed/Act; the empty one is the payload itself. Thread-safe: reading is.
class Payload {
 public:
  /// `bytes` must outlive it. Never throws for any bytes.
  explicit Payload(std::string_view bytes, PayloadForm form = PayloadForm::kJson);

  /// Returns true if it is JSON without the place. Payloads that are not JSON lack none: number_at() determines whether
  /// they can be read.
  bool lacks(const std::string& pointer) const;

  /// Returns the number at that place; nullopt if a JSON payload does not have the place, or has null there. Text that
  /// reads as a number counts as one, in JSON too. kInvalid: a text that stands for no value, as Home Assistant sends
  /// it (unavailable, unknown, none, an empty payload). kMalformed: not JSON, or something else there.
  Result<std::optional<double>, decode::Refusal> number_at(const std::string& pointer) const;

  /// The same for a direction in degrees, which can be a compass point, too ("NW"). kInvalid: also "VRB", a direction
  /// that varies.
  Result<std::optional<double>, decode::Refusal> direction_at(const std::string& pointer) const;

  /// Returns the text at that place, or a whole number as text, because identifiers are sent so; nullopt if it has
  /// neither.
  std::optional<std::string> text_at(const std::string& pointer) const;

  /// All of it; discarded (is_discarded()) if it is not JSON.
  const nlohmann::json& json() const noexcept { return json_; }

 private:
  const nlohmann::json* find(const std::string& pointer) const;

  std::string_view bytes_;
  nlohmann::json json_;
};

}  // namespace yuragi::drivers::mqtt
