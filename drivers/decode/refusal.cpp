#include "drivers/decode/refusal.hpp"

#include <array>

namespace yuragi::drivers::decode {

std::string_view name_of(Refusal refusal) {
  static constexpr std::array<std::string_view, kRefusalCount> kNames = {
      "timeout",   "too short", "not mine",    "bad checksum", "exception",
      "malformed", "invalid",   "implausible", "too frequent", "overrun"};
  return kNames.at(static_cast<std::size_t>(refusal));
}

}  // namespace yuragi::drivers::decode
